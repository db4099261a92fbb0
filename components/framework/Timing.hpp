#pragma once
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>

#include "types/Time.hpp"

namespace insonify::framework {

/** Durations in a histogram of 1 % steps from 0.1 us to 1000 s: adding never allocates; quantiles are within 1 %. */
class Statistics {
public:
    void add(double seconds);
    uint64_t count() const { return count_; }
    double median() const { return quantile(0.5); }
    double p99() const { return quantile(0.99); }
    double max() const { return max_; }
    /** Smallest duration that a share `q` of all does not exceed [s]; 0 when there is none. */
    double quantile(double q) const;

private:
    static constexpr int steps = 2315;  // ln(1e10) / ln(1.01)
    std::array<uint32_t, steps> histogram_{};
    uint64_t count_ = 0;
    double max_ = 0;
};

/** How a task keeps its times. Written on the task's thread and read when it has stopped, but for what is atomic. */
class Timing {
public:
    using Clock = std::chrono::steady_clock;

    Statistics jitter;      ///< From the instant at which a cycle of a periodic task was due to its begin [s].
    Statistics latency;     ///< From a sample's stamp to its being written, of all outputs whose samples have one [s].
    uint64_t overruns = 0;  ///< Periods that were left out, because cycles before them took too long.
    uint64_t late = 0;      ///< Samples that were written after the activity's deadline.
    uint64_t errors = 0;    ///< How often it went from Running to RunTimeError.
    std::atomic<uint64_t> hangs{0};  ///< Cycles that the watchdog has reported.

    void begin();  ///< A cycle begins.
    double end();  ///< It has ended; its duration without pauses [s].
    void pause();  ///< Within a cycle: what follows is waiting, not work.
    void resume() { since_ = ticks(); }
    void noteLatency(double seconds) {
        latency.add(seconds);
        last_latency_ = seconds;
    }
    double lastLatency() const { return last_latency_; }                    ///< Any thread [s].
    double lastCycle() const { return static_cast<double>(last_) * 1e-9; }  ///< Its duration; any thread [s].
    /** Since when it has been at work without a pause; 0: it is not. Any thread. */
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

/** A sample of that stamp has left the task, by a port or otherwise: in realtime its latency counts, and it is late
 *  after the activity's deadline. On the task's thread. */
void noteLatency(TaskContext& task, types::Time stamp);

}  // namespace insonify::framework
