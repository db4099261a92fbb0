#include "components/study/oracles/Workers.hpp"

#include <algorithm>

#include "types/Thread.hpp"

namespace insonify::study {

Workers::Workers() {
    const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
    threads_.reserve(cores);
    try {
        for (unsigned i = 1; i < cores; ++i)
            threads_.push_back(types::startThread("a worker of a path tracer", [this] { wait(); }));
    } catch (...) {
        end();
        throw;
    }
}

Workers::~Workers() { end(); }

void Workers::end() {
    {
        const std::lock_guard lock(mutex_);
        quit_ = true;
    }
    begun_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

void Workers::run(int count, Call call, const void* context) {
    {
        const std::lock_guard lock(mutex_);
        call_ = call, context_ = context, count_ = count, busy_ = size() - 1;
        next_ = 0;
        ++job_;
    }
    begun_.notify_all();
    runTurns();
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return busy_ == 0; });
}

void Workers::runTurns() {
    for (int i = next_++; i < count_; i = next_++) call_(context_, i);
}

void Workers::wait() {
    for (uint64_t last = 0;;) {
        {
            std::unique_lock lock(mutex_);
            begun_.wait(lock, [&] { return quit_ || job_ != last; });
            if (quit_) return;
            last = job_;
        }
        runTurns();
        const std::lock_guard lock(mutex_);
        if (--busy_ == 0) done_.notify_one();
    }
}

}  // namespace insonify::study
