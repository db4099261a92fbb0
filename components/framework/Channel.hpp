#pragma once
#include <atomic>
#include <utility>
#include <vector>

#include "components/framework/ConnPolicy.hpp"

namespace insonify::framework {

class OutputPortBase;

/** The queue of one connection: a ring of fixed capacity. Channel holds the samples; the mutex of the input port guards
 *  them. */
class ChannelBase {
public:
    ChannelBase(OutputPortBase& source, ConnPolicy policy);
    virtual ~ChannelBase() = default;
    ChannelBase(const ChannelBase&) = delete;
    ChannelBase& operator=(const ChannelBase&) = delete;
    OutputPortBase& source() const { return source_; }
    /** Samples that were refused, dropped or overwritten before they were read. */
    uint64_t lost() const { return lost_.load(std::memory_order_relaxed); }
    /** Samples that the reader took but skipped for newer samples, see InputPort::readNewest. */
    uint64_t passedOver() const { return passed_over_.load(std::memory_order_relaxed); }
    void notePassedOver() { passed_over_.fetch_add(1, std::memory_order_relaxed); }

    /** Copies a sample of the ports' type into the ring; false: refused, because the buffer is full. */
    bool push(const void* sample);
    /** Moves the oldest sample into `sample`, which has the ports' type; false: the ring is empty. */
    bool pop(void* sample);
    bool empty() const { return count_ == 0; }
    void clear();

protected:
    const size_t capacity_;

private:
    virtual void set(size_t slot, const void* sample) = 0;
    virtual void take(size_t slot, void* sample) = 0;
    virtual void drop(size_t slot) = 0;
    size_t wrapped(size_t slot) const { return slot < capacity_ ? slot : slot - capacity_; }

    OutputPortBase& source_;
    const ConnPolicy::Type type_;
    size_t first_ = 0, count_ = 0;
    std::atomic<uint64_t> lost_{0}, passed_over_{0};
};

template <class T>
class Channel final : public ChannelBase {
public:
    Channel(OutputPortBase& source, ConnPolicy policy) : ChannelBase(source, policy), ring_(capacity_) {}

private:
    void set(size_t slot, const void* sample) override { ring_[slot] = *static_cast<const T*>(sample); }
    void take(size_t slot, void* sample) override { *static_cast<T*>(sample) = std::move(ring_[slot]); }
    void drop(size_t slot) override { ring_[slot] = T{}; }

    std::vector<T> ring_;
};

}  // namespace insonify::framework
