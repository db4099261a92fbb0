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
class SerialExecutors {
public:
    static constexpr size_t max_waiting = 16;  ///< In one lane.
    using Work = std::function<void()>;        ///< Must not throw.

    SerialExecutors() = default;
    ~SerialExecutors() { end(); }
    SerialExecutors(const SerialExecutors&) = delete;
    SerialExecutors& operator=(const SerialExecutors&) = delete;

    /** False, and it is not done: too many wait in that lane, or all has ended. */
    bool run(const std::string& executor, Work work);
    /** What has begun ends before this returns; what waits is not begun. */
    void end();

private:
    struct Executor {
        std::deque<Work> waiting;
        std::condition_variable wake;
        std::thread thread;
    };
    void loop(Executor& executor);

    std::mutex mutex_;
    std::map<std::string, Executor> executors_;
    bool ending_ = false;
};

}  // namespace insonify::viewer
