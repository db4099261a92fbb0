#pragma once
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>

namespace insonify::viewer {

/** Work that may wait for long. What is in one lane runs in order, on a thread that begins with its first work; no lane
 *  waits for another. All functions are for any thread. */
class Lanes {
public:
    static constexpr size_t most_waiting = 16;  ///< In one lane.
    using Work = std::function<void()>;         ///< Must not throw.

    Lanes() = default;
    ~Lanes() { end(); }
    Lanes(const Lanes&) = delete;
    Lanes& operator=(const Lanes&) = delete;

    /** False, and it is not done: too many wait in that lane, or all has ended. */
    bool run(const std::string& lane, Work work);
    /** What has begun ends before this returns; what waits is not begun. */
    void end();

private:
    struct Lane {
        std::deque<Work> waiting;
        std::condition_variable wake;
        std::thread thread;
    };
    void loop(Lane& lane);

    std::mutex mutex_;
    std::map<std::string, Lane> lanes_;
    bool ending_ = false;
};

}  // namespace insonify::viewer
