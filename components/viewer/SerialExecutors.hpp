#pragma once
#include <atomic>
#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <map>
#include <mutex>
#include <string>

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
        std::atomic<size_t> waiting = 0;
        boost::asio::thread_pool thread{1};
    };

    std::mutex mutex_;
    std::map<std::string, Executor> executors_;
    bool ending_ = false;
};

}  // namespace insonify::viewer
