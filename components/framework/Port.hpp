#pragma once
// Typed ports. Small samples are copied; large samples are passed as std::shared_ptr<const T>, written once, never
// copied.
//
//     InputPort<types::Pose>         pose{this, "pose", "the vehicle in the world"};
//     OutputPort<types::SnapshotPtr> snapshot{this, "snapshot", "where each object is"};
//
// Ports connect and disconnect at any time, from any thread, while samples are written and read. A port's destructor
// disconnects it. At that moment the connected ports may be in use, but must not be destroyed or disconnected from this
// port, and no call on this port may run or begin. A writer never waits for a reader longer than the copying of one
// sample takes, whatever their priorities are: the mutexes of a port have priority inheritance.
#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "components/framework/TaskContext.hpp"
#include "components/framework/config/ConnPolicy.hpp"
#include "components/framework/execution/Activity.hpp"
#include "types/Thread.hpp"

namespace insonify::framework {

template <class T>
struct Pointee {
    using type = T;
};
template <class T>
struct Pointee<std::shared_ptr<const T>> {
    using type = T;
};

/** Types that count the progress of runs (`counted`), passed by value or by shared pointer. */
template <class T>
concept Counted = requires {
    requires Pointee<T>::type::counted;
};

/** Returns the name of a type in C++: "std::vector<double, std::allocator<double> >". */
std::string demangled(const std::type_info& type);

/** Returns the name of a type on a port; a shared pointer has the name of its sample: "/base/samples/Imu". */
template <class T>
std::string typeName() {
    using Value = typename Pointee<T>::type;
    if constexpr (requires { Value::type_name; })
        return Value::type_name;
    else if constexpr (std::is_same_v<Value, double>)
        return "/double";
    else if constexpr (std::is_same_v<Value, float>)
        return "/float";
    else if constexpr (std::is_same_v<Value, int32_t>)
        return "/int32_t";
    else if constexpr (std::is_same_v<Value, int64_t>)
        return "/int64_t";
    else if constexpr (std::is_same_v<Value, bool>)
        return "/bool";
    else if constexpr (std::is_same_v<Value, std::string>)
        return "/std/string";
    else
        return demangled(typeid(Value));
}

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

/** NoData: never written. OldData: the sample that was read before. NewData: a sample not read before. */
enum class FlowStatus { NoData, OldData, NewData };
enum class Need { Required, Optional };

/** The untyped part of a port. */
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
    /** What the samples are, in words, where samples of one type differ in meaning; empty: any. */
    const std::string& content() const { return content_; }
    std::string path() const { return owner_->name() + "." + name_; }
    virtual std::string typeName() const = 0;
    /** The C++ type of its samples, as the connections carry them. */
    virtual const std::type_info& type() const = 0;
    /** Whether runs are counted in these samples, see Counted. */
    virtual bool counted() const = 0;

private:
    TaskContext* owner_;
    std::string name_, doc_, content_;
};

class InputPortBase : public PortBase {
public:
    InputPortBase(TaskContext* owner, std::string name, std::string doc, Need need, std::string content);
    Need need() const { return need_; }
    bool connected() const;
    bool hasNew() const;
    /** Forgets every waiting and old sample; loss counters stay. */
    void clear();
    std::vector<std::shared_ptr<const ChannelBase>> channels() const;
    /** Whether a new sample wakes the task. */
    bool triggers() const { return triggers_; }
    void setTriggers(bool on) { triggers_ = on; }

    // For OutputPortBase only.
    std::shared_ptr<ChannelBase> connect(OutputPortBase& source, ConnPolicy policy);
    void drop(const OutputPortBase& source);
    /** Wakes the task if the sample is taken and this port triggers. */
    void push(ChannelBase& channel, const void* sample);

protected:
    void disconnectAll();
    // Used by InputPort, with a sample of its type.
    FlowStatus readInto(void* sample, bool copy_old);
    FlowStatus readNewestInto(void* sample, bool copy_old);
    FlowStatus readNextInto(void* sample);

private:
    virtual std::shared_ptr<ChannelBase> makeChannel(OutputPortBase& source, ConnPolicy policy) const = 0;
    virtual void* last() = 0;
    virtual void copyLast(void* sample) const = 0;
    virtual void setLast(const void* sample) = 0;
    virtual void forgetLast() = 0;
    virtual types::Time getStamp(const void* sample) const = 0;

    /** Takes the next sample into last(), under the mutex. Returns its channel; null: none waits. */
    std::shared_ptr<ChannelBase> consumeLast();
    /** Reads the next sample; sets `taken_from`, unless null, to the channel of a new sample. */
    FlowStatus readFrom(std::shared_ptr<ChannelBase>* taken_from, void* sample, bool copy_old);

    Need need_;
    bool triggers_ = true;
    mutable types::PriorityMutex mutex_;  ///< Guards the channels and their contents; held for one copy of a sample.
    std::vector<std::shared_ptr<ChannelBase>> channels_;
    bool has_last_ = false;
};

class OutputPortBase : public PortBase {
public:
    OutputPortBase(TaskContext* owner, std::string name, std::string doc, std::string content = "");
    ~OutputPortBase() override;
    /** False when the types differ. */
    bool connectTo(InputPortBase& reader, ConnPolicy policy);
    /** Ends every connection with `reader`: once this returns, no sample of this port reaches it. */
    void disconnect(InputPortBase& reader);
    bool connected() const;
    /** Keeps the last sample, for readers that connect later with `init`. A connection with `init` turns this on for
     *  later connections. */
    void keepLast();
    uint64_t written() const { return written_.load(std::memory_order_relaxed); }  ///< Samples since construction.

protected:
    /** Writes a sample of the port's type. */
    void writeFrom(const void* sample);
    /** Records the owner's latency in realtime, once a sample of this stamp has been written. */
    void noteWritten(types::Time stamp) const { noteLatency(owner(), stamp); }

private:
    struct Reader {
        InputPortBase* port;
        std::shared_ptr<ChannelBase> channel;
    };
    virtual const void* last() const = 0;
    virtual void setLast(const void* sample) = 0;

    std::atomic<uint64_t> written_{0};
    mutable types::PriorityMutex mutex_;  ///< Guards the list; locked before an input port's mutex, never after.
    std::vector<Reader> readers_;
    bool keep_last_ = false, has_last_ = false;
};

/** Returns the time stamp of a sample; of a type without one 0. */
template <class T>
types::Time portStamp(const T& sample) {
    if constexpr (requires { sample->time.microseconds; })
        return sample ? sample->time : types::Time{};
    else if constexpr (requires { sample.time.microseconds; })
        return sample.time;
    else
        return {};
}

template <class T>
class InputPort final : public InputPortBase {
public:
    InputPort(TaskContext* owner, std::string name, std::string doc, Need need = Need::Required,
              std::string content = "")
        : InputPortBase(owner, std::move(name), std::move(doc), need, std::move(content)) {}
    ~InputPort() override { disconnectAll(); }

    /** Reads the next sample. With OldData, `sample` becomes the last sample read, unless `copy_old` is false. */
    FlowStatus read(T& sample, bool copy_old = true) { return readInto(&sample, copy_old); }
    /** Drains the port and returns its newest sample: the last one of a connection; of several connections, the one
     *  with the latest stamp. The other samples count as skipped in their connections. */
    FlowStatus readNewest(T& sample, bool copy_old = true) { return readNewestInto(&sample, copy_old); }
    bool readNew(T& sample) { return read(sample, false) == FlowStatus::NewData; }
    /** Reads the sample to process: the next in lockstep, the newest (see readNewest) in realtime. False: no new
     *  sample. */
    bool readNext(T& sample) { return readNextInto(&sample) == FlowStatus::NewData; }

    std::string typeName() const override { return framework::typeName<T>(); }
    const std::type_info& type() const override { return typeid(T); }
    bool counted() const override { return Counted<T>; }

private:
    std::shared_ptr<ChannelBase> makeChannel(OutputPortBase& source, ConnPolicy policy) const override {
        return std::make_shared<Channel<T>>(source, policy);
    }
    void* last() override { return &last_; }
    void copyLast(void* sample) const override { *static_cast<T*>(sample) = last_; }
    void setLast(const void* sample) override { last_ = *static_cast<const T*>(sample); }
    types::Time getStamp(const void* sample) const override { return portStamp(*static_cast<const T*>(sample)); }
    void forgetLast() override { last_ = T{}; }

    T last_{};
};

template <class T>
class OutputPort final : public OutputPortBase {
public:
    using OutputPortBase::OutputPortBase;

    /** Throws std::logic_error for a null pointer to a sample, which no reader expects. */
    void write(const T& sample) {
        if constexpr (requires { sample->time.microseconds; })
            if (!sample) throw std::logic_error(path() + ": a null pointer was written; a sample is needed");
        writeFrom(&sample);
        if constexpr (
            requires { sample->time.microseconds; } || requires { sample.time.microseconds; })
            noteWritten(portStamp(sample));
    }
    std::string typeName() const override { return framework::typeName<T>(); }
    const std::type_info& type() const override { return typeid(T); }
    bool counted() const override { return Counted<T>; }

private:
    const void* last() const override { return &last_; }
    void setLast(const void* sample) override { last_ = *static_cast<const T*>(sample); }

    T last_{};
};

}  // namespace insonify::framework
