#pragma once
#include <atomic>
#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <map>
#include <mutex>
#include <string>

namespace insonify::viewer {

/** Runs work that may wait long. The work of one executor runs in order, on a thread that starts with its first work;
 *  executors do not wait for each other. Thread-safe. */
class SerialExecutors {
public:
    static constexpr size_t max_waiting = 16;  ///< In one executor.
    using Work = std::function<void()>;        ///< Must not throw.

    SerialExecutors() = default;
    ~SerialExecutors() { end(); }
    SerialExecutors(const SerialExecutors&) = delete;
    SerialExecutors& operator=(const SerialExecutors&) = delete;

    /** Queues work. Returns false, without running it, if too much work waits in that executor, or after end(). */
    bool run(const std::string& executor, Work work);
    /** Waits for running work; queued work is dropped. */
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
