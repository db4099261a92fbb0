#pragma once
#include <span>
#include <vector>

#include "components/acoustics/Pulse.hpp"
#include "components/sonar/fan/BinGrid.hpp"

namespace insonify::sonar {

/** What the pulse makes of a beam: each bin's echo spreads over its neighbours as h does (ACOUSTICS.md 5.12), the echo
 *  being spread evenly over its own bin and h taken in the middle of the others. */
class RangeResponse {
public:
    static constexpr double floor_db = -50;  ///< Sidelobes below it are left out.

    RangeResponse(const acoustics::Pulse& pulse, const BinGrid& grid);

    /** Room that `echoes` needs before its first and after its last bin, of zeros [bins]. */
    size_t margin() const { return taps_.size() / 2; }
    /** `echoes`: margin() zeros, one intensity for each of `bins`, margin() zeros. Allocates nothing. */
    void spread(std::span<const float> echoes, std::span<float> bins) const;

    const std::vector<float>& taps() const { return taps_; }  ///< Of bins from -margin() to margin() away [1].

private:
    std::vector<float> taps_;
};

/** Whether the pulse is so short that the bins, not it, are what range resolution there is. */
bool isShort(const acoustics::Pulse& pulse, const BinGrid& grid);

/** Slant range that a sonar resolves: a bin, or that of its pulse where that is longer [m]. */
double rangeCellOf(const SonarConfig& config);

}  // namespace insonify::sonar
