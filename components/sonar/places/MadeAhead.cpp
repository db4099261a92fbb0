#include "components/sonar/places/MadeAhead.hpp"

#include <algorithm>
#include <exception>

namespace insonify::sonar {
namespace {

std::shared_ptr<const void> madeOf(const MadeAhead::Item& item, const std::atomic<bool>& quits) try {
    return item.make(quits);
} catch (const std::exception&) {
    return nullptr;
}

}  // namespace

MadeAhead::~MadeAhead() {
    {
        const std::lock_guard alone(mutex_);
        quits_ = true;
    }
    asked_.notify_one();
    if (worker_.joinable()) worker_.join();
}

void MadeAhead::take(Items items) {
    {
        const std::lock_guard alone(mutex_);
        next_ = std::make_unique<const Items>(std::move(items));
    }
    if (!worker_.joinable()) worker_ = types::startThread(what_, [this] { work(); });
    asked_.notify_one();
}

bool MadeAhead::isDone() const {
    const std::lock_guard alone(mutex_);
    return !next_ && !is_working_;
}

void MadeAhead::work() {
    types::useDefaultScheduling();
    for (std::unique_lock<std::mutex> lock(mutex_);;) {
        is_working_ = false;
        asked_.wait(lock, [this] { return quits_ || next_; });
        if (quits_) return;
        is_working_ = true;
        const std::unique_ptr<const Items> items = std::exchange(next_, nullptr);
        std::vector<Made> made;
        for (size_t i = 0; i < items->size() && !quits_ && !next_; ++i) {
            lock.unlock();
            made.emplace_back((*items)[i].key, madeOf((*items)[i], quits_));
            lock.lock();
        }
        for (Made& old : made_)
            if (next_ && std::ranges::count(*next_, old.first, &Item::key) > 0) made.push_back(std::move(old));
        lock.unlock();
        made_ = std::move(made);  // only now, so that data that is still needed is not made twice
        lock.lock();
    }
}

}  // namespace insonify::sonar
