#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/sonar/config/SonarConfig.hpp"
#include "components/study/stability/StabilityStudy.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::study {

/** The comparison of two ways to render one ping. */
struct Ablation {
    double change = 0;                   ///< Max difference of a bin, relative to the strongest bin [1].
    double rel_l2_tvg = 0;               ///< M2 between the two (Metrics.hpp) [1].
    double without_ms = 0, with_ms = 0;  ///< Medians of a ping [ms].
};

/** An effect that a plan omits, or keeps, and its influence on bins and time. */
struct OmissionRow {
    std::string name, reason;
    std::optional<Ablation> measured;  ///< None: the effect is not built; `reason` explains it.
    std::optional<double> bound;       ///< Max change that the omission may cause [1].
    std::string bound_of;              ///< The quantity of the bound, and its origin.
    bool kept = false;                 ///< Configured: shown for its influence and cost.

    /** Returns whether the omission changes at most its bound; true without a bound. */
    bool holds() const;
};

/** Renders a sonar's ping as planned, and again with each omission put back (with neutral values for some), and with
 *  each kept effect removed. Both are timed alternately over `pings` pings. */
std::vector<OmissionRow> studyOmissions(const sonar::SonarConfig& config, const types::Snapshot& snapshot, int pings,
                                        const std::function<void(const std::string&)>& progress);

}  // namespace insonify::study
