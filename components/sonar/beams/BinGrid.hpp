#pragma once
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "components/acoustics/Pulse.hpp"
#include "components/sonar/config/SonarConfig.hpp"

namespace insonify::sonar {

/** Max bins of all beams of a ping: sums of 16 bytes take 256 MiB [1]. */
constexpr int64_t max_bins = int64_t{1} << 24;

/** Returns the number of the bin that contains a slant range, a whole number [m, m]. A range on an edge, within a
 *  rounding error of 1e-9 bins, belongs to the bin behind the edge. */
inline double binAt(double range, double bin_width) { return std::floor(range / bin_width + 1e-9); }

/** The range bins of a ping: bin k holds slant ranges [edge(k), edge(k + 1)). */
struct BinGrid {
    int bin_count = 0;            ///< [1]
    int64_t bin_duration_us = 0;  ///< One-way travel time through a bin, as in the sample [us].
    double bin_width = 0;         ///< Exact [m].
    double range_min = 0;         ///< Nearer echoes are blanked; objects there still cast shadows [m].
    double range_max = 0;         ///< Far edge of the last bin that can receive an echo [m].
    double speed_of_sound = 0;    ///< Exactly representable in the sample's float [m/s].

    double edge(int k) const { return k * bin_width; }            ///< [m]
    double centre(int k) const { return (k + 0.5) * bin_width; }  ///< [m]
};

/** Returns the bins of a configuration. `sample`: the bin lasts the configured time rounded up to whole microseconds
 *  (within 1e-6 of a whole number is that number; at least 1), and the edges follow. `exact`: the edges are as
 *  configured, and the duration is the nearest. `published`: bins are range/(bin_count - 1) wide, so that the last one
 *  only receives r = range_max. */
BinGrid makeBinGrid(const SonarConfig& config);

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
