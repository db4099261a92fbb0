#include "components/sonar/base/ThreadPool.hpp"

#include <algorithm>
#include <utility>

#include "types/Check.hpp"
#include "types/Thread.hpp"

namespace insonify::sonar {

constinit thread_local Counts thread_counts{};

ThreadPool::ThreadPool(int threads) {
    const int cores = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 16);
    const int count = threads > 0 ? threads : cores;
    workers_.reserve(static_cast<size_t>(count));
    try {
        for (int part = 1; part < count; ++part)
            workers_.push_back(types::startThread("a worker of a sonar", [this, part] { work(part); }));
    } catch (...) {
        end();
        throw;
    }
}

ThreadPool::~ThreadPool() { end(); }

void ThreadPool::end() {
    {
        std::lock_guard lock(mutex_);
        quit_ = true;
    }
    started_.notify_all();
    for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::start(Call call, const void* context) {
    process_.require("this pool of threads");
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

void ThreadPool::dismiss() {
    std::lock_guard lock(mutex_);
    busy_ -= std::exchange(waking_, 0);
}

std::exception_ptr ThreadPool::wait() {
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return busy_ == 0; });
    for (size_t i = 0; i < counter_count; ++i) thread_counts[i] += std::exchange(counted_[i], 0);
    return std::exchange(thrown_, {});
}

void ThreadPool::work(int part) {
    for (uint64_t seen = 0;;) {
        std::unique_lock lock(mutex_);
        started_.wait(lock, [&] { return quit_ || round_ != seen; });
        if (quit_) return;
        seen = round_;
        if (waking_ == 0) continue;
        --waking_;
        lock.unlock();
        const Counts before = thread_counts;
        const std::exception_ptr thrown = caught([&] { call_(context_, part, size()); });
        lock.lock();
        if (thrown) thrown_ = thrown;
        for (size_t i = 0; i < counter_count; ++i) counted_[i] += thread_counts[i] - before[i];
        if (--busy_ == 0) done_.notify_one();
    }
}

}  // namespace insonify::sonar
