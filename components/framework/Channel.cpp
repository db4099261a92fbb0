#include "components/framework/Channel.hpp"

namespace insonify::framework {

ChannelBase::ChannelBase(OutputPortBase& source, ConnPolicy policy)
    : capacity_(policy.type == ConnPolicy::Data ? 1 : policy.size), source_(source), type_(policy.type) {}

bool ChannelBase::push(const void* sample) {
    if (count_ == capacity_) {
        lost_.fetch_add(1, std::memory_order_relaxed);
        if (type_ == ConnPolicy::Buffer) return false;
        first_ = wrapped(first_ + 1);
        --count_;
    }
    set(wrapped(first_ + count_++), sample);
    return true;
}

bool ChannelBase::pop(void* sample) {
    if (count_ == 0) return false;
    take(first_, sample);
    first_ = wrapped(first_ + 1);
    --count_;
    return true;
}

void ChannelBase::clear() {
    for (; count_ > 0; --count_) {
        drop(first_);
        first_ = wrapped(first_ + 1);
    }
}

}  // namespace insonify::framework
