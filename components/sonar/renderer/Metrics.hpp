#pragma once
#include <cstdint>
#include <span>

namespace insonify::sonar {

/** Shape of the compared energies: [beam][bin], bins of equal width from range 0. */
struct Layout {
    int beams, bins;    ///< [1]
    double bin_width;   ///< [m]
    double range_from;  ///< Bins that begin nearer are ignored [m].
};

/** Differences of energies from their reference: ACOUSTICS.md 10, M1 to M6, without noise. M7 clamps levels below 1e-6
 *  of the reference's maximum to that level. Relative errors against a silent reference are 0 for silence and infinite
 *  for anything else. */
struct Metrics {
    double rel_l2 = 0;       ///< M1: |E - reference| / |reference| over all bins [1].
    double rel_l2_tvg = 0;   ///< M2: the same after a gain of 50 log10(r), so that far bins count as near bins do [1].
    double mean_rel_l2 = 0;  ///< M1 of each beam, and the mean over beams [1].
    double db_rmse = 0;      ///< M3, over bins above 1e-6 of the reference's maximum that both have [dB].
    double db_p95 = 0;       ///< M3: 95th percentile of |dB| over the same bins [dB].
    int missing_bins = 0;    ///< M3: zero where the reference is above that floor [1].
    int ghost_bins = 0;      ///< M3: above that floor where the reference is zero [1].
    double first_return_bins = 0;  ///< M4: 95th percentile over beams of the first return's error [bins].
    double shadow_bins = 0;        ///< M5: bins per beam that are in shadow for one and not for the other [bins].
    double energy_bias = 0;        ///< M6: sum(E) / sum(reference) - 1 [1].
    double ripple = 0;             ///< M6: rms over beams of energy / reference - 1 [1].
    double correlation = 0;        ///< Pearson's, over all bins; 1 where both are the same, 0 where one is flat [1].
    double level_distance = 0;     ///< M7: mean difference of the sorted levels (earth mover's distance) [dB].
    uint64_t hash = 0;             ///< M9: hash of the bits of E, all bins.
};

/** Compares `got` with `reference`, both [beam][bin]. */
Metrics compare(std::span<const float> got, std::span<const double> reference, const Layout& layout);

}  // namespace insonify::sonar
