#pragma once
#include <vector>

#include "components/sonar/SonarConfig.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** So many samples per beam, what error they leave and how long they take, as tried out on a scene. */
struct Quality {
    int rows = 0, columns_per_beam = 0;
    double error =
        0;  ///< Relative L2 of bin energies after a gain of 50 log10(r) (`physical`); of bins (`cerqueira2017`) [1].
    double ms = 0;  ///< Of one ping, the least of a few; 0 without a budget [ms].
};

/** Qualities of rising cost on this machine for what the sonar sees in a snapshot. Each doubles the rows or the columns
 * of the one before, whichever changes the bins more; how much they change tells the error. Ends with the first whose
 * error is at most `target_error`, or before the first that takes longer than `budget_ms`; never empty. */
std::vector<Quality> tryQualities(const SonarConfig& config, const types::Snapshot& scene, double target_error,
                                  double budget_ms);

/** Keeps pings within a time by going down and up a ladder of qualities. Down when 2 of the last 20 pings took more
 *  than 85 % of it, up when 100 in a row were so quick that the next quality would take less than 70 %. */
class BudgetKeeper {
public:
    /** `ladder`: of rising cost, not empty; begins at its last. */
    BudgetKeeper(std::vector<Quality> ladder, double budget_ms);
    const Quality& quality() const { return ladder_[at_]; }
    /** Hears how long a ping took [ms]; true when the quality is another one from now on. */
    bool heard(double ms);

private:
    bool moveTo(size_t at);

    std::vector<Quality> ladder_;
    double budget_ms_;
    size_t at_;
    int pings_ = 0, late_ = 0, early_ = 0;  ///< Since the last change, or of the last 20.
};

}  // namespace insonify::sonar
