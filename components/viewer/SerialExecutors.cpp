#include "components/viewer/SerialExecutors.hpp"

#include <boost/asio/post.hpp>

namespace insonify::viewer {

bool SerialExecutors::run(const std::string& name, Work work) {
    std::lock_guard lock(mutex_);
    if (ending_) return false;
    Executor& executor = executors_[name];
    if (executor.waiting == max_waiting) return false;
    ++executor.waiting;
    boost::asio::post(executor.thread, [&executor, work = std::move(work)] {
        --executor.waiting;
        work();
    });
    return true;
}

void SerialExecutors::end() {
    {
        std::lock_guard lock(mutex_);
        ending_ = true;
        for (auto& [name, executor] : executors_) executor.thread.stop();
    }
    for (auto& [name, executor] : executors_) executor.thread.join();
}

}  // namespace insonify::viewer
