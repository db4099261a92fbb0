#pragma once
#include <chrono>
#include <cstddef>
#include <string>

namespace insonify::console {

/** One line on a terminal, updated at most ten times a second and wiped at the end; prints nothing elsewhere. */
class ProgressLine {
public:
    explicit ProgressLine(bool wanted);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /** @param wall_s since the beginning [s] */
    void show(double wall_s, const std::string& text);

private:
    bool shown_;
    double next_s_ = 0.1;
};

/** Shows the current step of a study, its duration, the number of finished steps, and the remaining time. */
class StudyProgress {
public:
    /** @param total steps; 0: unknown */
    explicit StudyProgress(bool wanted, size_t total = 0);
    void operator()(const std::string& at);
    void advance() { ++done_; }  ///< One more step is done.
    void end();                  ///< Wipes the line.

private:
    bool shown_;
    size_t total_, done_ = 0;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/** Returns ", 12 % done, 34 s left" once `share` of the whole has taken `wall_s` [s]; empty if no share is known (0 or
 *  less) or all is done. */
std::string timeLeft(double share, double wall_s);

/** Returns "34 s", "5 min 03 s", "2 h 05 min". */
std::string durationText(double seconds);

}  // namespace insonify::console
