#pragma once
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace insonify::study {

/** Threads that persist between jobs: one per core, including the caller. */
class Workers {
public:
    /** Throws std::runtime_error if the system permits fewer threads. */
    Workers();
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    int size() const { return static_cast<int>(threads_.size()) + 1; }

    /** Calls job(i) once for each i in [0, count), on any thread and in any order; returns when all are done. Allocates
     *  nothing. The job must not throw. */
    template <class Job>
    void forEach(int count, const Job& job) {
        run(
            count, [](const void* context, int i) { (*static_cast<const Job*>(context))(i); }, &job);
    }

private:
    using Call = void (*)(const void*, int);
    void run(int count, Call call, const void* context);
    void runTurns();
    void wait();
    void end();

    std::vector<std::thread> threads_;
    std::mutex mutex_;
    std::condition_variable begun_, done_;
    Call call_ = nullptr;
    const void* context_ = nullptr;
    int count_ = 0, busy_ = 0;
    uint64_t job_ = 0;
    bool quit_ = false;
    std::atomic<int> next_ = 0;
};

}  // namespace insonify::study
