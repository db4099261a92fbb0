#pragma once
#include <vector>

#include "components/log/Stream.hpp"

namespace insonify::log {

/** The times of a log whose logger's clock was set back while it ran, without these steps.
 *
 *  A step is where a sample was received more than types::max_lateness before the sample that precedes it in the log.
 *  The samples from there on are later by the step, and by the interval between the two samples before it. A sample
 *  stamped before the step and received after it stays where it is. Steps forward are not told from pauses. */
class LoggerClock {
public:
    LoggerClock() = default;
    /** @param samples of a log, in its order */
    explicit LoggerClock(const std::vector<SampleRef>& samples);

    /** Returns the world time of a sample of the log without the steps; its recorded time where there are none. */
    types::Time evenTime(const SampleRef& at) const;
    /** Returns the time from the first of these samples, all of the log, to one of them, without the steps. */
    types::Time sinceFirst(const std::vector<SampleRef>& samples, const SampleRef& at) const;
    /** Returns the time from the first of all samples to the latest, without the steps. */
    types::Time span(const std::vector<SampleRef>& samples) const;
    /** Returns the index of the first sample, in the log's order, at least this time after the first of all [s]; their
     *  number: there is none. */
    size_t indexAt(const std::vector<SampleRef>& samples, double seconds) const;

private:
    struct Step {
        size_t number = 0;  ///< Of the first sample after it [1].
        types::Time shift;  ///< Of the times after it: the sum of the steps up to there.
    };
    std::vector<Step> steps_{Step{}};
};

}  // namespace insonify::log
