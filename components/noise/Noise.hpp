#pragma once
#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "components/noise/FieldFilter.hpp"
#include "components/noise/NoiseConfig.hpp"
#include "types/BeamArc.hpp"
#include "types/Sonar.hpp"

namespace insonify::noise {

/** Turns exponential variates t of unit mean into gamma variates of unit mean and a shape. The gamma variate is the
 *  quantile whose upper tail is exp(-t), from a table with 256 entries per octave of t, linear between them. */
class GammaTable {
public:
    /** Takes some milliseconds.
     *  @param shape from 1e-3 to 1e6 [1]; the variance is 1 / shape */
    explicit GammaTable(double shape);

    const float* values() const { return table_.data(); }
    /** Returns the gamma variate of an exponential variate t in [1e-10, 23]; `values` are those of a table. */
    static float variate(const float* values, float t) {
        const int32_t place = std::bit_cast<int32_t>(t) - first_bits;
        const int32_t cell = place >> cell_shift;
        const float rest = static_cast<float>(place & (cell_size - 1)) * (1.0f / cell_size);
        return values[cell] + rest * (values[cell + 1] - values[cell]);
    }

private:
    static constexpr int cell_shift = 15, cell_size = 1 << cell_shift;  ///< Size of a cell in the bits of t.
    static constexpr int32_t first_bits = std::bit_cast<int32_t>(0x1p-34f), last_bits = std::bit_cast<int32_t>(0x1p5f);

    std::vector<float> table_;
};

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
