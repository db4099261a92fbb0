#include "components/gazebo/Inbox.hpp"

#include <utility>

namespace insonify::gazebo {

void Inbox::put(Arrived message) {
    std::lock_guard lock(mutex_);
    if (!arrived_) return;
    if (messages_.size() >= capacity) {
        messages_.erase(messages_.begin());
        ++lost_;
    }
    messages_.push_back(std::move(message));
    arrived_();
}

std::vector<Arrived> Inbox::take() {
    std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
}

void Inbox::close() {
    std::lock_guard lock(mutex_);
    arrived_ = {};
    messages_.clear();
}

uint64_t Inbox::lost() const {
    std::lock_guard lock(mutex_);
    return lost_;
}

}  // namespace insonify::gazebo
