#include "components/sonar/base/ThreadPool.hpp"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <utility>

#include "types/Check.hpp"
#include "types/Thread.hpp"

namespace insonify::sonar {

constinit thread_local Counts thread_counts{};
constinit thread_local double divided_seconds = 0;

WorkerTeam::WorkerTeam(int parts) {
    workers_.reserve(static_cast<size_t>(parts));
    try {
        for (int part = 1; part < parts; ++part)
            workers_.push_back(types::startThread("a worker of a sonar", [this, part] { work(part); }));
    } catch (...) {
        end();
        throw;
    }
}

WorkerTeam::~WorkerTeam() { end(); }

void WorkerTeam::end() {
    {
        std::lock_guard lock(mutex_);
        quit_ = true;
    }
    started_.notify_all();
    for (std::thread& worker : workers_) worker.join();
}

void WorkerTeam::start(Call call, const void* context) {
    {
        std::lock_guard lock(mutex_);
        INSONIFY_CHECK(busy_ == 0, busy_);  // one job at a time
        call_ = call;
        context_ = context;
        busy_ = waking_ = static_cast<int>(workers_.size());
        ++round_;
    }
    started_.notify_all();
}

void WorkerTeam::dismiss() {
    std::lock_guard lock(mutex_);
    busy_ -= std::exchange(waking_, 0);
}

std::exception_ptr WorkerTeam::wait() {
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return busy_ == 0; });
    for (size_t i = 0; i < counter_count; ++i) thread_counts[i] += std::exchange(counted_[i], 0);
    return std::exchange(thrown_, {});
}

void WorkerTeam::work(int part) {
    for (uint64_t seen = 0;;) {
        std::unique_lock lock(mutex_);
        started_.wait(lock, [&] { return quit_ || round_ != seen; });
        if (quit_) return;
        seen = round_;
        if (waking_ == 0) continue;
        --waking_;
        lock.unlock();
        const Counts before = thread_counts;
        std::exception_ptr thrown;
        try {
            call_(context_, part, parts());
        } catch (...) {
            thrown = std::current_exception();
        }
        lock.lock();
        if (thrown) thrown_ = thrown;
        for (size_t i = 0; i < counter_count; ++i) counted_[i] += thread_counts[i] - before[i];
        if (--busy_ == 0) done_.notify_one();
    }
}

/** The teams of a process that pools share. They end with the last pool that shares any. */
class SharedTeams {
public:
    /** Returns the teams of this process. */
    static std::shared_ptr<SharedTeams> ofProcess() {
        static std::atomic<Registry*> registry = new Registry;
        Registry* known = registry;
        if (known->process.isForked()) {  // its mutex may be locked by a thread that stayed in the parent
            auto* const own = new Registry;
            if (registry.compare_exchange_strong(known, own))
                known = own;
            else
                delete own;
        }
        const std::lock_guard lock(known->mutex);
        std::shared_ptr<SharedTeams> teams = known->teams.lock();
        if (!teams) known->teams = teams = std::make_shared<SharedTeams>();
        return teams;
    }

    /** Returns an idle team with this thread's scheduling, which it starts if there is none. Throws std::runtime_error
     *  if the system permits fewer threads. */
    WorkerTeam& acquire(int parts) {
        const Kind kind(parts);
        {
            const std::lock_guard lock(mutex_);
            for (Entry& entry : entries_)
                if (!entry.is_busy && entry.kind == kind) {
                    entry.is_busy = true;
                    return *entry.team;
                }
        }
        auto team = std::make_unique<WorkerTeam>(parts);
        const std::lock_guard lock(mutex_);
        return *entries_.emplace_back(Entry{kind, std::move(team), true}).team;
    }

    void release(const WorkerTeam& team) {
        const std::lock_guard lock(mutex_);
        for (Entry& entry : entries_)
            if (entry.team.get() == &team) entry.is_busy = false;
    }

private:
    struct Registry {
        types::OwnProcess process;
        std::mutex mutex;
        std::weak_ptr<SharedTeams> teams;
    };
    /** The number of threads, and what they inherit from the thread that starts them. */
    struct Kind {
        explicit Kind(int count) : parts(count) {
            sched_param given{};
            if (pthread_getschedparam(pthread_self(), &policy, &given) == 0) priority = given.sched_priority;
            CPU_ZERO(&cpus);
            sched_getaffinity(0, sizeof cpus, &cpus);
        }
        bool operator==(const Kind& other) const {
            return parts == other.parts && policy == other.policy && priority == other.priority &&
                   CPU_EQUAL(&cpus, &other.cpus);
        }
        int parts, policy = SCHED_OTHER, priority = 0;
        cpu_set_t cpus;
    };
    struct Entry {
        Kind kind;
        std::unique_ptr<WorkerTeam> team;
        bool is_busy;
    };

    types::PriorityMutex mutex_;
    std::vector<Entry> entries_;
};

ThreadPool::ThreadPool(int threads, Threads whose)
    : size_(threads > 0 ? threads : std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 16)) {
    if (size_ == 1) return;
    if (whose == Threads::Own) {
        own_ = std::make_unique<WorkerTeam>(size_);
    } else {
        shared_ = SharedTeams::ofProcess();
        shared_->release(shared_->acquire(size_));  // so that what the system refuses is an error here
    }
}

ThreadPool::~ThreadPool() = default;

ThreadPool::Lease::Lease(ThreadPool& pool, WorkerTeam::Call call, const void* context) : pool_(pool) {
    pool.process_.require("this pool of threads");
    team_ = pool.own_.get();
    if (pool.shared_) try {
            team_ = &pool.shared_->acquire(pool.size_);
        } catch (const std::runtime_error&) {  // the caller does all parts
        }
    if (team_) team_->start(call, context);
}

ThreadPool::Lease::~Lease() {
    if (team_ && pool_.shared_) pool_.shared_->release(*team_);
}

}  // namespace insonify::sonar
