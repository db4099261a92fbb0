#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "components/noise/FieldFilter.hpp"
#include "components/noise/GammaTable.hpp"
#include "components/noise/NoiseConfig.hpp"
#include "types/Sonar.hpp"

namespace insonify::noise {

/** Puts noise on the intensities of pings, as it reaches the receiver.
 *
 *  Speckle multiplies. The noise of the sea is added: with `rayleigh` and `k` as fields, which is one exponential
 *  variate about the sum of both means; with the other laws as an intensity of its own, exponentially distributed.
 *
 *  The variate of a bin depends on (seed, ping, beam, bin) alone, where the ping is known by its time in microseconds:
 *  a replayed log gets the noise of the run that it came from. */
class Noise {
public:
    explicit Noise(const NoiseConfig& config);

    /** Gives `noisy` everything of `clean` and its bins with noise. NaN stays NaN, and nothing that was not negative
     *  becomes negative. Allocates nothing once a ping of this shape has been there.
     *  @return how many gaussian factors were below 0 and clamped. */
    uint64_t add(const types::Sonar& clean, types::Sonar& noisy);

    /** Mean intensity of what is added to a bin; 0 where nothing is [1]. */
    double background() const { return static_cast<double>(ambient_) + static_cast<double>(additive_); }

private:
    struct Run;
    /** Filtered variates of all bins of a ping: what multiplies echoes, the sea's noise and additive noise; empty
     * without. */
    struct Filtered {
        std::vector<float> factor, ambient, additive;
    };
    bool addsAmbient() const;
    void drawFiltered(const types::Sonar& ping, uint64_t seed);
    uint64_t addTo(const Run& run) const;
    uint64_t multiply(const Run& run) const;

    NoiseConfig config_;
    std::optional<GammaTable> gamma_;  ///< Of laws gamma and k.
    std::optional<FieldFilter> filter_;
    Filtered filtered_;
    float ambient_ = 0, additive_ = 0;  ///< Mean intensities [1].
};

}  // namespace insonify::noise
