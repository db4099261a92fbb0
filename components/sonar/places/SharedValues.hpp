#pragma once
#include <map>
#include <memory>
#include <mutex>

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
    std::mutex mutex_;
    std::map<Key, std::weak_ptr<Value>> values_;
};

/** A value that is made at the first request. Thread-safe; other threads wait for the first. */
template <class Value>
class Lazy {
public:
    template <class Make>
    const Value& get(const Make& make) {
        std::call_once(once_, [&] {
            value_ = make();
            made_ = true;
        });
        return value_;
    }
    /** Calls `change(value)` where it has been made. Nobody may ask for it meanwhile. */
    void renew(const auto& change) {
        if (made_) change(value_);
    }

private:
    std::once_flag once_;
    bool made_ = false;
    Value value_{};
};

}  // namespace insonify::sonar
