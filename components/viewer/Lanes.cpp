#include "components/viewer/Lanes.hpp"

namespace insonify::viewer {

bool Lanes::run(const std::string& name, Work work) {
    std::lock_guard lock(mutex_);
    if (ending_) return false;
    Lane& lane = lanes_[name];
    if (lane.waiting.size() == most_waiting) return false;
    lane.waiting.push_back(std::move(work));
    if (!lane.thread.joinable()) lane.thread = std::thread([this, &lane] { loop(lane); });
    lane.wake.notify_one();
    return true;
}

void Lanes::end() {
    {
        std::lock_guard lock(mutex_);
        ending_ = true;
        for (auto& [name, lane] : lanes_) lane.wake.notify_one();
    }
    for (auto& [name, lane] : lanes_)
        if (lane.thread.joinable()) lane.thread.join();
}

void Lanes::loop(Lane& lane) {
    std::unique_lock lock(mutex_);
    while (true) {
        lane.wake.wait(lock, [&] { return ending_ || !lane.waiting.empty(); });
        if (ending_) return;
        const Work work = std::move(lane.waiting.front());
        lane.waiting.pop_front();
        lock.unlock();
        work();
        lock.lock();
    }
}

}  // namespace insonify::viewer
