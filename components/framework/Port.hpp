#pragma once
// Typed ports. Small samples travel by value; large ones as std::shared_ptr<const T>, written once, never copied.
//
//     InputPort<types::Pose>      pose{this, "pose", "the vehicle in the world"};
//     OutputPort<types::SonarPtr> ping{this, "ping", "one ping, noiseless"};
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "components/framework/ConnPolicy.hpp"
#include "components/framework/TaskContext.hpp"
#include "types/TypeName.hpp"

namespace insonify::framework {

/** NoData: never written. OldData: the sample that was read before, again. NewData: one not read before. */
enum class FlowStatus { NoData, OldData, NewData };
enum class Need { Required, Optional };

/** What is known of a port without its type. */
class PortBase {
public:
    PortBase(TaskContext* owner, std::string name, std::string doc)
        : owner_(owner), name_(std::move(name)), doc_(std::move(doc)) {}
    virtual ~PortBase() = default;
    PortBase(const PortBase&) = delete;
    PortBase& operator=(const PortBase&) = delete;
    TaskContext& owner() const { return *owner_; }
    const std::string& name() const { return name_; }
    const std::string& doc() const { return doc_; }
    std::string path() const { return owner_->name() + "." + name_; }
    virtual std::string typeName() const = 0;

private:
    TaskContext* owner_;
    std::string name_, doc_;
};

class OutputPortBase;

/** The reading end of one connection, without its type. */
class ChannelBase {
public:
    explicit ChannelBase(const OutputPortBase& source) : source_(source) {}
    virtual ~ChannelBase() = default;
    const OutputPortBase& source() const { return source_; }
    /** Samples that were refused, dropped or overwritten before they were read. */
    virtual uint64_t lost() const = 0;

private:
    const OutputPortBase& source_;
};

class InputPortBase : public PortBase {
public:
    InputPortBase(TaskContext* owner, std::string name, std::string doc, Need need)
        : PortBase(owner, std::move(name), std::move(doc)), need_(need) {
        owner->enlist(this);
    }
    Need need() const { return need_; }
    virtual bool connected() const = 0;
    virtual bool hasNew() const = 0;
    /** Forgets every waiting and old sample; loss counters stay. */
    virtual void clear() = 0;
    virtual std::vector<const ChannelBase*> channels() const = 0;
    /** Whether a new sample wakes the task. */
    bool triggers() const { return triggers_; }
    uint64_t taken() const { return taken_; }  ///< Samples read since construction; for the task's thread.
    void setTriggers(bool on) { triggers_ = on; }

protected:
    void signal() const;  ///< A sample has arrived: wakes the task if this port triggers.
    uint64_t taken_ = 0;

private:
    Need need_;
    bool triggers_ = true;
};

/** Where samples of one connection wait: a ring of fixed capacity. Writers are never blocked by a slow reader. */
template <class T>
class Channel final : public ChannelBase {
public:
    Channel(const OutputPortBase& source, ConnPolicy policy)
        : ChannelBase(source), policy_(policy), ring_(policy.type == ConnPolicy::Data ? 1 : policy.size) {}

    /** False when the sample was refused (full buffer). */
    bool push(const T& sample) {
        std::lock_guard lock(mutex_);
        if (count_ == ring_.size()) {
            ++lost_;
            if (policy_.type == ConnPolicy::Buffer) return false;
            first_ = (first_ + 1) % ring_.size();
            --count_;
        }
        ring_[(first_ + count_++) % ring_.size()] = sample;
        return true;
    }
    bool pop(T& sample) {
        std::lock_guard lock(mutex_);
        if (count_ == 0) return false;
        sample = std::move(ring_[first_]);
        first_ = (first_ + 1) % ring_.size();
        --count_;
        return true;
    }
    bool empty() const {
        std::lock_guard lock(mutex_);
        return count_ == 0;
    }
    void clear() {
        for (T dropped; pop(dropped);) {
        }
    }
    uint64_t lost() const override {
        std::lock_guard lock(mutex_);
        return lost_;
    }

private:
    mutable std::mutex mutex_;
    ConnPolicy policy_;
    std::vector<T> ring_;
    size_t first_ = 0, count_ = 0;
    uint64_t lost_ = 0;
};

template <class T>
class InputPort final : public InputPortBase {
public:
    InputPort(TaskContext* owner, std::string name, std::string doc, Need need = Need::Required)
        : InputPortBase(owner, std::move(name), std::move(doc), need) {}

    /** The next sample; with OldData `sample` becomes the last one read, unless `copy_old` is false. */
    FlowStatus read(T& sample, bool copy_old = true) {
        for (const auto& channel : channels_)
            if (channel->pop(last_)) {
                has_last_ = true;
                ++taken_;
                sample = last_;
                return FlowStatus::NewData;
            }
        if (!has_last_) return FlowStatus::NoData;
        if (copy_old) sample = last_;
        return FlowStatus::OldData;
    }
    /** Drains the port and gives the newest sample. */
    FlowStatus readNewest(T& sample, bool copy_old = true) {
        const FlowStatus first = read(sample, copy_old);
        if (first == FlowStatus::NewData)
            while (read(sample, false) == FlowStatus::NewData) {
            }
        return first;
    }
    bool readNew(T& sample) { return read(sample, false) == FlowStatus::NewData; }

    std::string typeName() const override { return types::typeName<T>(); }
    bool connected() const override { return !channels_.empty(); }
    bool hasNew() const override {
        for (const auto& channel : channels_)
            if (!channel->empty()) return true;
        return false;
    }
    void clear() override {
        for (const auto& channel : channels_) channel->clear();
        last_ = T{};
        has_last_ = false;
    }
    std::vector<const ChannelBase*> channels() const override {
        std::vector<const ChannelBase*> all;
        for (const auto& channel : channels_) all.push_back(channel.get());
        return all;
    }
    /** For OutputPort: adds a connection. Not while the task runs. */
    Channel<T>& connect(const OutputPortBase& source, ConnPolicy policy) {
        return *channels_.emplace_back(std::make_unique<Channel<T>>(source, policy));
    }
    void push(Channel<T>& channel, const T& sample) {
        if (channel.push(sample)) signal();
    }

private:
    std::vector<std::unique_ptr<Channel<T>>> channels_;
    T last_{};
    bool has_last_ = false;
};

class OutputPortBase : public PortBase {
public:
    OutputPortBase(TaskContext* owner, std::string name, std::string doc)
        : PortBase(owner, std::move(name), std::move(doc)) {
        owner->enlist(this);
    }
    /** False when the types differ. Not while either task runs. */
    virtual bool connectTo(InputPortBase& reader, ConnPolicy policy) = 0;
    /** An input port of this port's type, for a task that takes whatever is connected to it. */
    virtual std::unique_ptr<InputPortBase> makeReader(TaskContext* owner, const std::string& name) const = 0;
    virtual bool connected() const = 0;
    uint64_t written() const { return written_.load(std::memory_order_relaxed); }  ///< Samples since construction.

protected:
    std::atomic<uint64_t> written_{0};
};

template <class T>
class OutputPort final : public OutputPortBase {
public:
    using OutputPortBase::OutputPortBase;
    void write(const T& sample) {
        written_.fetch_add(1, std::memory_order_relaxed);
        for (const Reader& reader : readers_) reader.port->push(*reader.channel, sample);
        if (keep_last_) last_ = sample;
        has_last_ = keep_last_;
    }
    std::string typeName() const override { return types::typeName<T>(); }
    bool connected() const override { return !readers_.empty(); }
    bool connectTo(InputPortBase& reader, ConnPolicy policy) override {
        auto* port = dynamic_cast<InputPort<T>*>(&reader);
        if (!port) return false;
        Channel<T>& channel = port->connect(*this, policy);
        readers_.push_back({port, &channel});
        keep_last_ = keep_last_ || policy.init;
        if (policy.init && has_last_) port->push(channel, last_);
        return true;
    }
    std::unique_ptr<InputPortBase> makeReader(TaskContext* owner, const std::string& name) const override {
        return std::make_unique<InputPort<T>>(owner, name, "samples of " + path(), Need::Optional);
    }

private:
    struct Reader {
        InputPort<T>* port;
        Channel<T>* channel;
    };
    std::vector<Reader> readers_;
    T last_{};
    bool keep_last_ = false, has_last_ = false;
};

}  // namespace insonify::framework
