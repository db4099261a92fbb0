#pragma once
#include <atomic>
#include <utility>
#include <vector>

#include "components/framework/ConnPolicy.hpp"

namespace insonify::framework {

class OutputPortBase;

/** The reading end of one connection, without its type. */
class ChannelBase {
public:
    explicit ChannelBase(OutputPortBase& source) : source_(source) {}
    virtual ~ChannelBase() = default;
    ChannelBase(const ChannelBase&) = delete;
    ChannelBase& operator=(const ChannelBase&) = delete;
    OutputPortBase& source() const { return source_; }
    /** Samples that were refused, dropped or overwritten before they were read. */
    uint64_t lost() const { return lost_.load(std::memory_order_relaxed); }
    /** Samples that the reader has taken and left aside for newer ones, see InputPort::readNewest. */
    uint64_t passedOver() const { return passed_over_.load(std::memory_order_relaxed); }
    void notePassedOver() { passed_over_.fetch_add(1, std::memory_order_relaxed); }

protected:
    std::atomic<uint64_t> lost_{0};

private:
    OutputPortBase& source_;
    std::atomic<uint64_t> passed_over_{0};
};

/** Where samples of one connection wait: a ring of fixed capacity. The mutex of its input port guards it. */
template <class T>
class Channel final : public ChannelBase {
public:
    Channel(OutputPortBase& source, ConnPolicy policy)
        : ChannelBase(source), policy_(policy), ring_(policy.type == ConnPolicy::Data ? 1 : policy.size) {}

    /** False when the sample was refused (full buffer). */
    bool push(const T& sample) {
        if (count_ == ring_.size()) {
            lost_.fetch_add(1, std::memory_order_relaxed);
            if (policy_.type == ConnPolicy::Buffer) return false;
            first_ = wrapped(first_ + 1);
            --count_;
        }
        ring_[wrapped(first_ + count_++)] = sample;
        return true;
    }
    bool pop(T& sample) {
        if (count_ == 0) return false;
        sample = std::move(ring_[first_]);
        first_ = wrapped(first_ + 1);
        --count_;
        return true;
    }
    bool empty() const { return count_ == 0; }
    void clear() {
        for (T dropped; pop(dropped);) {
        }
    }

private:
    size_t wrapped(size_t index) const { return index < ring_.size() ? index : index - ring_.size(); }

    ConnPolicy policy_;
    std::vector<T> ring_;
    size_t first_ = 0, count_ = 0;
};

}  // namespace insonify::framework
