#pragma once
#include <atomic>
#include <map>
#include <memory>
#include <mutex>

#include "types/Thread.hpp"

namespace insonify::sonar {

/** Values shared by all callers with the same key. A value lives as long as a caller holds it. */
template <class Key, class Value>
class SharedValues {
public:
    /** Returns the value of a key; calls `make()` where no caller holds it. Thread-safe; all threads wait while a value
     *  is made. */
    std::shared_ptr<Value> of(const Key& key, const auto& make) {
        const std::lock_guard alone(mutex_);
        const auto known = values_.find(key);
        if (known != values_.end())
            if (auto value = known->second.lock()) return value;
        std::erase_if(values_, [](const auto& each) { return each.second.expired(); });
        std::shared_ptr<Value> made = make();
        values_.emplace(key, made);
        return made;
    }

private:
    types::PriorityMutex mutex_;
    std::map<Key, std::weak_ptr<Value>> values_;
};

/** Work that is done once, at the first call. Thread-safe; other threads wait for the first, and lend it their priority
 *  meanwhile. Work that throws is done again at the next call. */
class Once {
public:
    void call(const auto& work) {
        if (done_.load(std::memory_order_acquire)) return;
        const std::lock_guard alone(mutex_);
        if (done_.load(std::memory_order_relaxed)) return;
        work();
        done_.store(true, std::memory_order_release);
    }
    bool isDone() const { return done_.load(std::memory_order_acquire); }

private:
    types::PriorityMutex mutex_;
    std::atomic<bool> done_{false};
};

/** A value that is made at the first request, by Once. */
template <class Value>
class Lazy {
public:
    template <class Make>
    const Value& get(const Make& make) {
        once_.call([&] { value_ = make(); });
        return value_;
    }
    /** Calls `change(value)` where it has been made. Nobody may ask for it meanwhile. */
    void renew(const auto& change) {
        if (once_.isDone()) change(value_);
    }

private:
    Once once_;
    Value value_{};
};

}  // namespace insonify::sonar
