#include "components/framework/Port.hpp"

#include <cxxabi.h>

#include <cstdlib>

namespace insonify::framework {

std::string demangled(const std::type_info& type) {
    int failed = 0;
    const std::unique_ptr<char, decltype(&std::free)> name(abi::__cxa_demangle(type.name(), nullptr, nullptr, &failed),
                                                           &std::free);
    return failed == 0 ? name.get() : type.name();
}

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

InputPortBase::InputPortBase(TaskContext* owner, std::string name, std::string doc, Need need, std::string content)
    : PortBase(owner, std::move(name), std::move(doc), std::move(content)), need_(need) {
    owner->enlist(this);
}

bool InputPortBase::connected() const {
    std::lock_guard lock(mutex_);
    return !channels_.empty();
}

bool InputPortBase::hasNew() const {
    std::lock_guard lock(mutex_);
    for (const auto& channel : channels_)
        if (!channel->empty()) return true;
    return false;
}

void InputPortBase::clear() {
    std::lock_guard lock(mutex_);
    for (const auto& channel : channels_) channel->clear();
    forgetLast();
    has_last_ = false;
}

std::vector<std::shared_ptr<const ChannelBase>> InputPortBase::channels() const {
    std::lock_guard lock(mutex_);
    return {channels_.begin(), channels_.end()};
}

void InputPortBase::disconnectAll() {
    for (const auto& channel : channels()) channel->source().disconnect(*this);
}

std::shared_ptr<ChannelBase> InputPortBase::consumeLast() {
    for (const auto& channel : channels_)
        if (channel->pop(last())) {
            has_last_ = true;
            owner().noteTaken();
            return channel;
        }
    return nullptr;
}

FlowStatus InputPortBase::readFrom(std::shared_ptr<ChannelBase>* taken_from, void* sample, bool copy_old) {
    std::lock_guard lock(mutex_);
    if (auto channel = consumeLast()) {
        copyLast(sample);
        if (taken_from) *taken_from = std::move(channel);
        return FlowStatus::NewData;
    }
    if (!has_last_) return FlowStatus::NoData;
    if (copy_old) copyLast(sample);
    return FlowStatus::OldData;
}

FlowStatus InputPortBase::readInto(void* sample, bool copy_old) { return readFrom(nullptr, sample, copy_old); }

FlowStatus InputPortBase::readNewestInto(void* sample, bool copy_old) {
    std::shared_ptr<ChannelBase> newest;
    const FlowStatus first = readFrom(&newest, sample, copy_old);
    bool is_last = true;  // whether `sample` is the last one taken
    while (first == FlowStatus::NewData) {
        std::lock_guard lock(mutex_);
        auto next = consumeLast();
        if (!next && !is_last) setLast(sample);
        if (!next) break;
        is_last = next == newest || getStamp(last()) >= getStamp(sample);
        if (is_last) {
            copyLast(sample);
            std::swap(newest, next);
        }
        next->notePassedOver();
    }
    return first;
}

FlowStatus InputPortBase::readNextInto(void* sample) {
    return owner().activity().realtime() ? readNewestInto(sample, false) : readInto(sample, false);
}

std::shared_ptr<ChannelBase> InputPortBase::connect(OutputPortBase& source, ConnPolicy policy) {
    auto channel = makeChannel(source, policy);
    std::lock_guard lock(mutex_);
    return channels_.emplace_back(std::move(channel));
}

void InputPortBase::drop(const OutputPortBase& source) {
    std::lock_guard lock(mutex_);
    std::erase_if(channels_, [&](const auto& channel) { return &channel->source() == &source; });
    if (!channels_.empty()) return;
    forgetLast();
    has_last_ = false;
}

void InputPortBase::push(ChannelBase& channel, const void* sample) {
    bool taken = false;
    {
        std::lock_guard lock(mutex_);
        taken = channel.push(sample);
    }
    if (taken && triggers_) owner().activity().trigger();
}

OutputPortBase::OutputPortBase(TaskContext* owner, std::string name, std::string doc, std::string content)
    : PortBase(owner, std::move(name), std::move(doc), std::move(content)) {
    owner->enlist(this);
}

OutputPortBase::~OutputPortBase() {
    std::lock_guard lock(mutex_);
    for (const Reader& reader : readers_) reader.port->drop(*this);
}

bool OutputPortBase::connectTo(InputPortBase& reader, ConnPolicy policy) {
    if (reader.type() != type()) return false;
    std::lock_guard lock(mutex_);
    readers_.push_back({&reader, reader.connect(*this, policy)});
    keep_last_ = keep_last_ || policy.init;
    if (policy.init && has_last_) reader.push(*readers_.back().channel, last());
    return true;
}

void OutputPortBase::disconnect(InputPortBase& reader) {
    std::lock_guard lock(mutex_);
    std::erase_if(readers_, [&](const Reader& other) { return other.port == &reader; });
    reader.drop(*this);
}

bool OutputPortBase::connected() const {
    std::lock_guard lock(mutex_);
    return !readers_.empty();
}

void OutputPortBase::keepLast() {
    std::lock_guard lock(mutex_);
    keep_last_ = true;
}

void OutputPortBase::writeFrom(const void* sample) {
    written_.fetch_add(1, std::memory_order_relaxed);
    std::lock_guard lock(mutex_);
    for (const Reader& reader : readers_) reader.port->push(*reader.channel, sample);
    if (keep_last_) setLast(sample);
    has_last_ = keep_last_;
}

}  // namespace insonify::framework
