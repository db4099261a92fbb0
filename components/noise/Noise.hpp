#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "components/noise/FieldFilter.hpp"
#include "components/noise/GammaTable.hpp"
#include "components/noise/NoiseConfig.hpp"
#include "types/BeamArc.hpp"
#include "types/Sonar.hpp"

namespace insonify::noise {

/** Adds speckle and noise to the intensities of pings before they reach the receiver.
 *
 *  Speckle multiplies. The noise of the sea is added. With `rayleigh` and `k` it is added as a field: one exponential
 *  variate scales the sum of both means. With the other laws it is a separate, exponentially distributed intensity.
 *
 *  The variate of a bin depends only on (seed, ping, beam, bin), where the ping is identified by its time in
 *  microseconds. A replayed log therefore gets the same noise as the original run. */
class Noise {
public:
    explicit Noise(const NoiseConfig& config);

    /** Copies `clean` to `noisy` and adds noise to the bins. NaN stays NaN, and no bin becomes negative unless it was.
     *  Allocates nothing after the first ping of this shape.
     *  @return the number of gaussian factors that were below 0 and clamped */
    uint64_t add(const types::Sonar& clean, types::Sonar& noisy);

    /** Returns the mean intensity that is added to a bin; 0 without added noise [1]. */
    double background() const { return static_cast<double>(ambient_) + static_cast<double>(additive_); }

private:
    struct Run;
    /** Filtered variates of all bins of a ping: for the factor on echoes, the noise of the sea and additive noise.
     *  Empty when not used. */
    struct Filtered {
        std::vector<float> factor, ambient, additive;
    };
    bool addsAmbient() const;
    void takeOrder(const types::Sonar& ping);
    void drawFiltered(const types::Sonar& ping, uint64_t seed);
    uint64_t addTo(const Run& run) const;
    uint64_t multiply(const Run& run) const;

    NoiseConfig config_;
    std::optional<GammaTable> gamma_;  ///< Table of laws gamma and k.
    std::optional<FieldFilter> filter_;
    Filtered filtered_;
    types::BeamArc arc_;
    BeamOrder order_;                   ///< Of the beams of the ping, for the filter.
    float ambient_ = 0, additive_ = 0;  ///< Mean intensities [1].
};

}  // namespace insonify::noise
