#pragma once
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "components/sonar/base/Counters.hpp"
#include "types/OwnProcess.hpp"

namespace insonify::sonar {

/** A few threads that share the parts of one job. Running a job allocates nothing, and what its threads count
 *  (Counters.hpp) is counted by the caller. In a forked child, where the threads are missing, it throws
 *  std::runtime_error. */
class ThreadPool {
public:
    /** `threads` counts the caller; 0: the number of the machine's cores, at most 16. Throws std::runtime_error if the
     *  system permits fewer threads. */
    explicit ThreadPool(int threads = 0);
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    int size() const { return static_cast<int>(workers_.size()) + 1; }
    /** Calls job(part, size()) once for each part in [0, size()). The caller does part 0, and a worker always does the
     *  same part. Returns when all are done. Throws what a part threw, the caller's first. */
    template <class Job>
    void run(const Job& job) {
        start([](const void* context, int part, int parts) { (*static_cast<const Job*>(context))(part, parts); }, &job);
        std::exception_ptr thrown = caught([&] { job(0, size()); });
        std::exception_ptr other = wait();
        if (thrown || other) std::rethrow_exception(thrown ? thrown : other);
    }

    /** Calls job(part, size()) on the caller, and on the workers that begin before the caller is done, each with its
     *  own number. It is for jobs that the available threads share. Does not wait for workers that have not begun. */
    template <class Job>
    void share(const Job& job) {
        start([](const void* context, int part, int parts) { (*static_cast<const Job*>(context))(part, parts); }, &job);
        std::exception_ptr thrown = caught([&] { job(0, size()); });
        dismiss();
        std::exception_ptr other = wait();
        if (thrown || other) std::rethrow_exception(thrown ? thrown : other);
    }

private:
    using Call = void (*)(const void*, int, int);
    static std::exception_ptr caught(const auto& work) {
        try {
            work();
        } catch (...) {
            return std::current_exception();
        }
        return {};
    }
    void start(Call call, const void* context);
    std::exception_ptr wait();
    /** Releases the workers that have not begun. */
    void dismiss();
    void work(int part);
    /** Ends the workers, of which there may be fewer than wanted. */
    void end();

    types::OwnProcess process_;
    std::vector<std::thread> workers_;
    std::mutex mutex_;
    std::condition_variable started_, done_;
    Call call_ = nullptr;
    const void* context_ = nullptr;
    uint64_t round_ = 0;
    int busy_ = 0, waking_ = 0;  ///< Workers that are not done, and the part of these that has not begun.
    std::exception_ptr thrown_;
    Counts counted_{};  ///< What the workers have counted in this job.
    bool quit_ = false;
};

}  // namespace insonify::sonar
