#include "components/viewer/SerialExecutors.hpp"

namespace insonify::viewer {

bool SerialExecutors::run(const std::string& name, Work work) {
    std::lock_guard lock(mutex_);
    if (ending_) return false;
    Executor& executor = executors_[name];
    if (executor.waiting.size() == max_waiting) return false;
    executor.waiting.push_back(std::move(work));
    if (!executor.thread.joinable()) executor.thread = std::thread([this, &executor] { loop(executor); });
    executor.wake.notify_one();
    return true;
}

void SerialExecutors::end() {
    {
        std::lock_guard lock(mutex_);
        ending_ = true;
        for (auto& [name, executor] : executors_) executor.wake.notify_one();
    }
    for (auto& [name, executor] : executors_)
        if (executor.thread.joinable()) executor.thread.join();
}

void SerialExecutors::loop(Executor& executor) {
    std::unique_lock lock(mutex_);
    while (true) {
        executor.wake.wait(lock, [&] { return ending_ || !executor.waiting.empty(); });
        if (ending_) return;
        const Work work = std::move(executor.waiting.front());
        executor.waiting.pop_front();
        lock.unlock();
        work();
        lock.lock();
    }
}

}  // namespace insonify::viewer
