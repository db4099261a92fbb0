#pragma once
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "components/sonar/base/Counters.hpp"
#include "types/Thread.hpp"

namespace insonify::sonar {

/** Workers that do the parts of one job after the other. */
class WorkerTeam {
public:
    using Call = void (*)(const void*, int, int);

    /** Starts the workers of a job in `parts` parts, with the scheduling of this thread. Throws std::runtime_error if
     *  the system permits fewer threads. */
    explicit WorkerTeam(int parts);
    ~WorkerTeam();
    WorkerTeam(const WorkerTeam&) = delete;
    WorkerTeam& operator=(const WorkerTeam&) = delete;

    int parts() const { return static_cast<int>(workers_.size()) + 1; }
    /** Starts the parts from 1 on. */
    void start(Call call, const void* context);
    /** Releases the workers that have not begun. */
    void dismiss();
    /** Waits for the parts, and returns what one of them threw. */
    std::exception_ptr wait();

private:
    void work(int part);
    /** Ends the workers, of which there may be fewer than wanted. */
    void end();

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

class SharedTeams;

/** Time that this thread has spent in jobs of its pools since it started, with its waits for workers [s]. The rest of a
 *  ping's time is not divided among threads. */
extern constinit thread_local double divided_seconds;

/** A few threads that share the parts of one job. Running a job allocates nothing, and what its threads count
 *  (Counters.hpp) is counted by the caller. In a forked child, where the threads are missing, it throws
 *  std::runtime_error.
 *
 *  A pool has threads of its own, or shares them: then a job runs on idle threads of the process that have the caller's
 *  scheduling. So hundreds of sonars that ping one after the other have the threads of one, and sonars that ping at the
 *  same time have threads each. */
class ThreadPool {
public:
    enum class Threads { Own, Shared };

    /** `threads` counts the caller; 0: the number of the machine's cores, at most 16. Throws std::runtime_error if the
     *  system permits fewer threads. */
    explicit ThreadPool(int threads = 0, Threads whose = Threads::Own);
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    int size() const { return size_; }
    /** Calls job(part, size()) once for each part in [0, size()). The caller does part 0, and a worker of an own pool
     *  always does the same part. Returns when all are done. Throws what a part threw, the caller's first. */
    template <class Job>
    void run(const Job& job) {
        const Lap lap;
        const Lease team(*this, &invoke<Job>, &job);
        std::exception_ptr thrown = caught([&] { job(0, size()); });
        for (int part = 1; part < size() && !team; ++part)
            if (std::exception_ptr other = caught([&] { job(part, size()); }); !thrown) thrown = other;
        std::exception_ptr other = team ? team->wait() : nullptr;
        if (thrown || other) std::rethrow_exception(thrown ? thrown : other);
    }

    /** Calls job(part, size()) on the caller, and on the workers that begin before the caller is done, each with its
     *  own number. It is for jobs that the available threads share. Does not wait for workers that have not begun. */
    template <class Job>
    void share(const Job& job) {
        const Lap lap;
        const Lease team(*this, &invoke<Job>, &job);
        std::exception_ptr thrown = caught([&] { job(0, size()); });
        if (team) team->dismiss();
        std::exception_ptr other = team ? team->wait() : nullptr;
        if (thrown || other) std::rethrow_exception(thrown ? thrown : other);
    }

private:
    /** Adds its life to divided_seconds, once where jobs run within each other. */
    struct Lap {
        ~Lap() {
            divided_seconds = before + std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        }
        double before = divided_seconds;
        std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    };
    /** The team of one job, which has started; none for a pool of one thread, and where the system refuses another
     *  team: then the caller does all parts. */
    class Lease {
    public:
        Lease(ThreadPool& pool, WorkerTeam::Call call, const void* context);
        ~Lease();
        Lease(const Lease&) = delete;
        Lease& operator=(const Lease&) = delete;
        explicit operator bool() const { return team_ != nullptr; }
        WorkerTeam* operator->() const { return team_; }

    private:
        ThreadPool& pool_;
        WorkerTeam* team_ = nullptr;
    };
    template <class Job>
    static void invoke(const void* context, int part, int parts) {
        (*static_cast<const Job*>(context))(part, parts);
    }
    static std::exception_ptr caught(const auto& work) {
        try {
            work();
        } catch (...) {
            return std::current_exception();
        }
        return {};
    }

    types::OwnProcess process_;
    int size_;
    std::unique_ptr<WorkerTeam> own_;      ///< Null for one thread, and where they are shared.
    std::shared_ptr<SharedTeams> shared_;  ///< Null otherwise.
};

}  // namespace insonify::sonar
