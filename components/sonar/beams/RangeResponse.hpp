#pragma once
#include <span>
#include <vector>

#include "components/acoustics/Pulse.hpp"
#include "components/sonar/beams/BinGrid.hpp"

namespace insonify::sonar {

/** The pulse's effect on a beam: each bin's echo spreads over its neighbours by h (ACOUSTICS.md 5.12). The echo is
 *  assumed uniform over its own bin, and h is evaluated in the middle of the others. */
class RangeResponse {
public:
    static constexpr double floor_db = -50;  ///< Sidelobes below it are omitted [dB].

    RangeResponse(const acoustics::Pulse& pulse, const BinGrid& grid);

    /** Returns the number of zero bins that `echoes` needs before its first and after its last bin [bins]. */
    size_t margin() const { return taps_.size() / 2; }
    /** Spreads echoes into `bins`. `echoes`: margin() zeros, one intensity for each of `bins`, margin() zeros.
     *  Allocates nothing. */
    void spread(std::span<const float> echoes, std::span<float> bins) const;

    const std::vector<float>& taps() const { return taps_; }  ///< Weights of bins from -margin() to margin() away [1].

private:
    std::vector<float> taps_;
};

/** Returns whether the pulse is so short that the bins determine the range resolution. */
bool isShort(const acoustics::Pulse& pulse, const BinGrid& grid);

/** Returns the range resolution of a sonar: a bin, or that of its pulse where it is longer [m]. */
double rangeCell(const SonarConfig& config);

}  // namespace insonify::sonar
