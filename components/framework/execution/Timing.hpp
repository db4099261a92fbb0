#pragma once
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>

#include "types/Time.hpp"

namespace insonify::framework {

/** A histogram of durations in 1 % steps from 0.1 us to 1000 s: adding never allocates; quantiles are within 1 %. */
class Statistics {
public:
    void add(double seconds);
    uint64_t count() const { return count_; }
    double median() const { return quantile(0.5); }
    double p99() const { return quantile(0.99); }
    double max() const { return max_; }
    /** Returns the duration that a share `q` of all durations does not exceed [s]; 0 when there is none. */
    double quantile(double q) const;

private:
    static constexpr int steps = 2315;  // ln(1e10) / ln(1.01)
    std::array<uint32_t, steps> histogram_{};
    uint64_t count_ = 0;
    double max_ = 0;
};

/** The times of a task. Written on the task's thread and read when the task has stopped, except the atomic members. */
class Timing {
public:
    using Clock = std::chrono::steady_clock;

    Statistics jitter;      ///< Delay of a periodic task's cycle after its due instant [s].
    Statistics latency;     ///< From a sample's stamp to its writing, for outputs whose samples have a stamp [s].
    uint64_t overruns = 0;  ///< Periods skipped because earlier cycles took too long.
    uint64_t late = 0;      ///< Samples written after the activity's deadline.
    uint64_t errors = 0;    ///< Number of changes from Running to RunTimeError.
    std::atomic<uint64_t> hangs{0};  ///< Cycles that the watchdog has reported.

    void begin();  ///< A cycle begins.
    double end();  ///< Ends the cycle; returns its duration without pauses [s].
    void pause();  ///< Within a cycle: waiting begins.
    void resume() { since_ = ticks(); }
    void noteLatency(double seconds) {
        latency.add(seconds);
        last_latency_ = seconds;
    }
    double lastLatency() const { return last_latency_; }                    ///< Any thread [s].
    double lastCycle() const { return static_cast<double>(last_) * 1e-9; }  ///< Its duration; any thread [s].
    /** Start of the current work without a pause; 0: the task is not working. Any thread. */
    std::chrono::nanoseconds workingSince() const { return std::chrono::nanoseconds(since_.load()); }
    static int64_t ticks() { return std::chrono::nanoseconds(Clock::now().time_since_epoch()).count(); }

private:
    std::atomic<int64_t> since_{0};
    std::atomic<double> last_latency_{0};
    std::atomic<int64_t> last_{0};
    int64_t worked_ = 0;  ///< In this cycle, before its last pause [ns].
};

inline void Timing::begin() {
    worked_ = 0;
    resume();
}
inline void Timing::pause() { worked_ += ticks() - since_.exchange(0); }
inline double Timing::end() {
    pause();
    last_ = worked_;
    return static_cast<double>(worked_) * 1e-9;
}

class TaskContext;

/** Records that a sample of that stamp has left the task, by a port or otherwise. In realtime its latency counts, and
 *  the sample is late after the activity's deadline. On the task's thread. */
void noteLatency(TaskContext& task, types::Time stamp);

}  // namespace insonify::framework
