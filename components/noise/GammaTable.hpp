#pragma once
#include <bit>
#include <cstdint>
#include <vector>

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

}  // namespace insonify::noise
