#include "components/sonar/base/MadeAhead.hpp"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <set>

namespace insonify::sonar {
namespace {

std::shared_ptr<const void> makeAhead(const MadeAhead::Item& item, const std::atomic<bool>& quits) try {
    return item.make(quits);
} catch (const std::exception&) {
    return nullptr;
}

/** All that have a thread. A program may end by exit() while it has sonars; threads must end before the data that all
 *  share, and the libraries that they use, are destroyed. */
struct Running {
    std::mutex mutex;
    std::set<MadeAhead*> all;

    static Running& get() {
        static Running& running = *new Running;  // NOLINT: never destroyed
        return running;
    }
};

}  // namespace

MadeAhead::~MadeAhead() {
    if (!worker_.joinable()) return;
    if (process_.isForked()) {
        worker_.detach();                     // a child has no such thread,
        static_cast<void>(asked_.release());  // for which the end of the condition would wait
        return;
    }
    {
        const std::lock_guard alone(Running::get().mutex);
        Running::get().all.erase(this);
    }
    end();
}

void MadeAhead::end() {
    {
        const std::lock_guard alone(mutex_);
        quits_ = true;
    }
    asked_->notify_one();
    if (worker_.joinable()) worker_.join();
}

void MadeAhead::start() {
    worker_ = types::startThread(what_, [this] { work(); });
    static const types::OwnProcess process;
    static const int registered = std::atexit([] {
        if (process.isForked()) return;
        const std::lock_guard alone(Running::get().mutex);
        for (MadeAhead* each : Running::get().all) each->end();
    });
    static_cast<void>(registered);
    const std::lock_guard alone(Running::get().mutex);
    Running::get().all.insert(this);
}

void MadeAhead::take(Items items) {
    if (process_.isForked() || quits_) return;
    if (!worker_.joinable()) try {
            start();
        } catch (const std::runtime_error&) {
            return;  // the system permits no more threads: pings make what they need themselves
        }
    {
        const std::lock_guard alone(mutex_);
        next_ = std::make_unique<const Items>(std::move(items));
    }
    asked_->notify_one();
}

bool MadeAhead::isDone() const {
    const std::lock_guard alone(mutex_);
    return !next_ && !is_working_;
}

void MadeAhead::work() {
    types::useDefaultScheduling();
    for (std::unique_lock<std::mutex> lock(mutex_);;) {
        is_working_ = false;
        asked_->wait(lock, [this] { return quits_ || next_; });
        if (quits_) return;
        is_working_ = true;
        const std::unique_ptr<const Items> items = std::exchange(next_, nullptr);
        std::vector<Made> made;
        for (size_t i = 0; i < items->size() && !quits_ && !next_; ++i) {
            lock.unlock();
            made.emplace_back((*items)[i].key, makeAhead((*items)[i], quits_));
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
