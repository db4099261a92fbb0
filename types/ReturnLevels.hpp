#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "types/samples/RangeBins.hpp"

namespace insonify::types {

/** What is known of a sonar's bins, to tell returns from what is none. The defaults know nothing. */
struct ReturnRules {
    bool spreads = false;      ///< Echoes fall with r^2 and `loss_db_per_m`, as before a receiver's TVG.
    double loss_db_per_m = 0;  ///< Absorption of a plane wave, one way.
    double range_min = 0;      ///< Nearer bins are blanked [m].
    double ring_down_db = -std::numeric_limits<double>::infinity();  ///< The transmitter's ring-down at range 0 [dB].
    double ring_down_db_per_m = 1;                                   ///< Its decay with slant range.
    bool operator==(const ReturnRules&) const = default;
};

/** The level of a ping's bins for the detection of returns, as devices detect them: without spreading and absorption,
 *  without the ring-down, and without blanked bins (ACOUSTICS.md 5.16).
 *
 *      levels.take(ping, rules, ping.bin_count);
 *      if (levels.at(k, ping.bins[k]) >= minimum) ...    // a return */
class ReturnLevels {
public:
    /** Computes the tables for bins. Allocates nothing where bins and rules are those of the last call. */
    void take(const RangeBins& bins, uint32_t count, const ReturnRules& rules);
    /** Returns the level of bin k, whose value is `received`, as a linear number; 0 for a bin that is blanked, unknown,
     *  or not stronger than twice the ring-down. */
    double at(size_t k, double received) const { return k >= first_ ? unblanked(k, received) : 0; }
    /** Returns the same also for a blanked bin. */
    double unblanked(size_t k, double received) const {
        const double rung = k < ring_down_.size() ? ring_down_[k] : 0, echo = received - rung;
        return echo > rung ? echo * gain_[k] : 0;
    }
    /** Returns the factor by which levels exceed the bins of echoes. */
    double gain(size_t k) const { return gain_[k]; }
    size_t first() const { return first_; }  ///< First bin that is not blanked.

private:
    RangeBins bins_;
    ReturnRules rules_;
    size_t first_ = 0;
    std::vector<double> gain_, ring_down_;  ///< [m^2]; of the first bins [1].
};

}  // namespace insonify::types
