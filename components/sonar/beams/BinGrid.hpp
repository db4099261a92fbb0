#pragma once
#include <cmath>
#include <cstdint>

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

}  // namespace insonify::sonar
