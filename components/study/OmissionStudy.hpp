#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/sonar/plan/SonarConfig.hpp"
#include "components/study/StabilityStudy.hpp"
#include "types/Snapshot.hpp"

namespace insonify::study {

/** Two ways to render one ping, compared. */
struct Ablation {
    double change = 0;                   ///< Largest difference of a bin over the loudest bin [1].
    double rel_l2_tvg = 0;               ///< M2 between the two (Metrics.hpp) [1].
    double without_ms = 0, with_ms = 0;  ///< Of a ping, medians [ms].
};

/** What a plan leaves out, or an effect that it keeps, with what that does to bins and time. */
struct OmissionRow {
    std::string name, reason;
    std::optional<Ablation> measured;  ///< None: `reason` is all there is, as the effect is not built.
    std::optional<double> bound;       ///< Of what leaving it out may change [1].
    std::string bound_of;              ///< What the bound is of, and where it comes from.
    bool kept = false;                 ///< Configured: shown for what it does and costs.

    /** Whether what was left out changes no more than its bound; true where there is nothing to judge. */
    bool holds() const;
};

/** Renders a sonar's ping as planned, and again with each thing that its plan leaves out put back (with neutral values
 *  where it has some), or each effect that it keeps taken away. `pings` are timed of either, in turns. */
std::vector<OmissionRow> studyOmissions(const sonar::SonarConfig& config, const types::Snapshot& snapshot, int pings,
                                        const std::function<void(const std::string&)>& progress);

}  // namespace insonify::study
