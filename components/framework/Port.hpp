#pragma once
// Typed ports. Small samples travel by value; large ones as std::shared_ptr<const T>, written once, never copied.
//
//     InputPort<types::Pose>         pose{this, "pose", "the vehicle in the world"};
//     OutputPort<types::SnapshotPtr> snapshot{this, "snapshot", "what stands where"};
//
// Ports connect and disconnect at any time, from any thread, while samples are written and read. One that goes
// disconnects itself, whatever the ports at its other ends do meanwhile, except that they must not go or be
// disconnected from it at that moment; no call on the port itself may be under way or begin. A writer waits for no
// reader: at most for the copying of one sample.
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "components/framework/Activity.hpp"
#include "components/framework/Channel.hpp"
#include "components/framework/TaskContext.hpp"
#include "types/TypeName.hpp"

namespace insonify::framework {

/** NoData: never written. OldData: the sample that was read before, again. NewData: one not read before. */
enum class FlowStatus { NoData, OldData, NewData };
enum class Need { Required, Optional };

/** What is known of a port without its type. */
class PortBase {
public:
    PortBase(TaskContext* owner, std::string name, std::string doc, std::string content)
        : owner_(owner), name_(std::move(name)), doc_(std::move(doc)), content_(std::move(content)) {}
    virtual ~PortBase() = default;
    PortBase(const PortBase&) = delete;
    PortBase& operator=(const PortBase&) = delete;
    TaskContext& owner() const { return *owner_; }
    const std::string& name() const { return name_; }
    const std::string& doc() const { return doc_; }
    /** What its samples are, in words, where not all of their type are the same; empty: any. */
    const std::string& content() const { return content_; }
    std::string path() const { return owner_->name() + "." + name_; }
    virtual std::string typeName() const = 0;
    /** Whether its samples are what runs are counted in, see types::Counted. */
    virtual bool counted() const = 0;

private:
    TaskContext* owner_;
    std::string name_, doc_, content_;
};

class InputPortBase : public PortBase {
public:
    InputPortBase(TaskContext* owner, std::string name, std::string doc, Need need, std::string content)
        : PortBase(owner, std::move(name), std::move(doc), std::move(content)), need_(need) {
        owner->enlist(this);
    }
    Need need() const { return need_; }
    virtual bool connected() const = 0;
    virtual bool hasNew() const = 0;
    /** Forgets every waiting and old sample; loss counters stay. */
    virtual void clear() = 0;
    virtual std::vector<std::shared_ptr<const ChannelBase>> channels() const = 0;
    /** For OutputPort, which calls this when it disconnects. */
    virtual void drop(const OutputPortBase& source) = 0;
    /** Whether a new sample wakes the task. */
    bool triggers() const { return triggers_; }
    void setTriggers(bool on) { triggers_ = on; }

protected:
    /** A sample has arrived: wakes the task if this port triggers. */
    void signal() const {
        if (triggers_) owner().activity().trigger();
    }
    bool newestCounts() const { return owner().activity().realtime(); }  ///< The task runs in realtime.

private:
    Need need_;
    bool triggers_ = true;
};

class OutputPortBase : public PortBase {
public:
    OutputPortBase(TaskContext* owner, std::string name, std::string doc, std::string content = "")
        : PortBase(owner, std::move(name), std::move(doc), std::move(content)) {
        owner->enlist(this);
    }
    /** False when the types differ. */
    virtual bool connectTo(InputPortBase& reader, ConnPolicy policy) = 0;
    /** Ends every connection with `reader`: once this returns nothing of this port reaches it any more. */
    virtual void disconnect(InputPortBase& reader) = 0;
    virtual bool connected() const = 0;
    uint64_t written() const { return written_.load(std::memory_order_relaxed); }  ///< Samples since construction.

protected:
    /** A sample of this stamp has been written: the owner's latency in realtime. */
    void noteWritten(types::Time stamp) const { noteLatency(owner(), stamp); }

    std::atomic<uint64_t> written_{0};
};

template <class T>
class InputPort final : public InputPortBase {
public:
    InputPort(TaskContext* owner, std::string name, std::string doc, Need need = Need::Required,
              std::string content = "")
        : InputPortBase(owner, std::move(name), std::move(doc), need, std::move(content)) {}
    ~InputPort() override {
        for (const auto& channel : channels()) channel->source().disconnect(*this);
    }

    /** The next sample; with OldData `sample` becomes the last one read, unless `copy_old` is false. */
    FlowStatus read(T& sample, bool copy_old = true) { return readFrom(nullptr, sample, copy_old); }
    /** Drains the port and gives the newest sample; those before it count as passed over in their connections. */
    FlowStatus readNewest(T& sample, bool copy_old = true) {
        std::shared_ptr<ChannelBase> taken_from, next_from;
        const FlowStatus first = readFrom(&taken_from, sample, copy_old);
        for (; first == FlowStatus::NewData && readFrom(&next_from, sample, false) == FlowStatus::NewData;
             taken_from = std::move(next_from))
            taken_from->notePassedOver();
        return first;
    }
    bool readNew(T& sample) { return read(sample, false) == FlowStatus::NewData; }
    /** The sample to work on: in lockstep the next; in realtime the newest, as of readNewest. False: none is new. */
    bool takeNext(T& sample) {
        return newestCounts() ? readNewest(sample, false) == FlowStatus::NewData : readNew(sample);
    }

    std::string typeName() const override { return types::typeName<T>(); }
    bool counted() const override { return types::Counted<T>; }
    bool connected() const override {
        std::lock_guard lock(mutex_);
        return !channels_.empty();
    }
    bool hasNew() const override {
        std::lock_guard lock(mutex_);
        for (const auto& channel : channels_)
            if (!channel->empty()) return true;
        return false;
    }
    void clear() override {
        std::lock_guard lock(mutex_);
        for (const auto& channel : channels_) channel->clear();
        forgetLast();
    }
    std::vector<std::shared_ptr<const ChannelBase>> channels() const override {
        std::lock_guard lock(mutex_);
        return {channels_.begin(), channels_.end()};
    }
    void drop(const OutputPortBase& source) override {
        std::lock_guard lock(mutex_);
        std::erase_if(channels_, [&](const auto& channel) { return &channel->source() == &source; });
        if (channels_.empty()) forgetLast();
    }

    // For OutputPort only.
    std::shared_ptr<Channel<T>> connect(OutputPortBase& source, ConnPolicy policy) {
        auto channel = std::make_shared<Channel<T>>(source, policy);
        std::lock_guard lock(mutex_);
        return channels_.emplace_back(std::move(channel));
    }
    void push(Channel<T>& channel, const T& sample) {
        bool taken = false;
        {
            std::lock_guard lock(mutex_);
            taken = channel.push(sample);
        }
        if (taken) signal();
    }

private:
    /** read(), which tells where a new sample was taken from, to who wants to know. */
    FlowStatus readFrom(std::shared_ptr<ChannelBase>* taken_from, T& sample, bool copy_old) {
        std::lock_guard lock(mutex_);
        for (const auto& channel : channels_)
            if (channel->pop(last_)) {
                has_last_ = true;
                owner().noteTaken();
                sample = last_;
                if (taken_from) *taken_from = channel;
                return FlowStatus::NewData;
            }
        if (!has_last_) return FlowStatus::NoData;
        if (copy_old) sample = last_;
        return FlowStatus::OldData;
    }
    void forgetLast() {
        last_ = T{};
        has_last_ = false;
    }

    mutable std::mutex mutex_;  ///< Of the channels and all in them; held for one copy of a sample.
    std::vector<std::shared_ptr<Channel<T>>> channels_;
    T last_{};
    bool has_last_ = false;
};

template <class T>
class OutputPort final : public OutputPortBase {
public:
    using OutputPortBase::OutputPortBase;
    ~OutputPort() override {
        std::lock_guard lock(mutex_);
        for (const Reader& reader : readers_) reader.port->drop(*this);
    }
    void write(const T& sample) {
        written_.fetch_add(1, std::memory_order_relaxed);
        std::lock_guard lock(mutex_);
        for (const Reader& reader : readers_) reader.port->push(*reader.channel, sample);
        if (keep_last_) last_ = sample;
        has_last_ = keep_last_;
        if constexpr (requires { sample->time.microseconds; })
            noteWritten(sample ? sample->time : types::Time{});
        else if constexpr (requires { sample.time.microseconds; })
            noteWritten(sample.time);
    }
    /** From now on a reader that connects later, with `init`, gets the last sample. A connection with `init` sees to
     *  that itself, for those after it. */
    void keepLast() {
        std::lock_guard lock(mutex_);
        keep_last_ = true;
    }
    std::string typeName() const override { return types::typeName<T>(); }
    bool counted() const override { return types::Counted<T>; }
    bool connected() const override {
        std::lock_guard lock(mutex_);
        return !readers_.empty();
    }
    bool connectTo(InputPortBase& reader, ConnPolicy policy) override {
        auto* port = dynamic_cast<InputPort<T>*>(&reader);
        if (!port) return false;
        std::lock_guard lock(mutex_);
        readers_.push_back({port, port->connect(*this, policy)});
        keep_last_ = keep_last_ || policy.init;
        if (policy.init && has_last_) port->push(*readers_.back().channel, last_);
        return true;
    }
    void disconnect(InputPortBase& reader) override {
        std::lock_guard lock(mutex_);
        std::erase_if(readers_, [&](const Reader& other) { return other.port == &reader; });
        reader.drop(*this);
    }

private:
    struct Reader {
        InputPort<T>* port;
        std::shared_ptr<Channel<T>> channel;
    };
    mutable std::mutex mutex_;  ///< Of the list; taken before that of an input port, never after.
    std::vector<Reader> readers_;
    T last_{};
    bool keep_last_ = false, has_last_ = false;
};

}  // namespace insonify::framework
