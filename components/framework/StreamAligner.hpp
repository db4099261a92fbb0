#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "components/framework/Port.hpp"
#include "types/Time.hpp"

namespace insonify::framework {

class StreamAligner;

/** Of a sample that has not come yet. */
constexpr types::Time before_all{std::numeric_limits<int64_t>::min()};

/** One of the ports of a StreamAligner, without its type. */
class AlignedPortBase {
public:
    /** Since the aligner was cleared last [samples]. */
    struct Counts {
        uint64_t received = 0;
        uint64_t late = 0;     ///< Dropped: older than what had been handed over, or than the one before on the port.
        uint64_t awaited = 0;  ///< Samples of other ports that went on without one of this port, after the timeout.
    };
    AlignedPortBase(StreamAligner& aligner, const InputPortBase& port);
    virtual ~AlignedPortBase() = default;
    AlignedPortBase(const AlignedPortBase&) = delete;
    AlignedPortBase& operator=(const AlignedPortBase&) = delete;

    const Counts& counts() const { return counts_; }
    /** "ping: 3 of 120 samples came too late and were dropped": what was lost or not waited for; empty: nothing. */
    std::string notice() const;

protected:
    friend class StreamAligner;
    virtual bool empty() const = 0;
    virtual bool full() const = 0;
    virtual types::Time firstTime() const = 0;  ///< Of the oldest that waits; there must be one.
    virtual bool fill() = 0;                    ///< Takes what is new while there is room; false: nothing was.
    virtual void handOver() = 0;                ///< The oldest that waits.
    virtual void forget() = 0;
    /** Takes note of a sample, and whether it still has a place in the order of time. */
    bool accepts(types::Time time);

    StreamAligner& aligner_;
    const InputPortBase& port_;
    Counts counts_;
    types::Time last_ = before_all;  ///< Of the newest sample.
};

/** Hands over what comes in on several ports in the order of the samples' own time, whatever the order of their
 *  arrival, as Rock's stream aligner does.
 *
 *      framework::StreamAligner aligner_;
 *      framework::AlignedPort<types::Pose> poses_{aligner_, pose, [this](const types::Pose& sample) { ... }};
 *      framework::AlignedPort<types::SonarPtr> pings_{aligner_, ping, [this](const types::SonarPtr& sample) { ... }};
 *      bool startHook() override { return aligner_.clear(1.0), true; }
 *      void updateHook() override { aligner_.update(); }
 *
 *  A sample waits until every other port has one that is as late or later, so that none before it can come. It waits
 *  no longer once some port has a sample `timeout` later, or its own has no more room: a port that is silent holds up
 *  the others for so long and no more, and what it has missed is counted. Samples of one time come in the order in
 *  which their ports were declared. Late samples are dropped and counted. No clock is read: the same samples in the
 *  same order give the same. */
class StreamAligner {
public:
    void clear(double timeout);  ///< Forgets samples and counts; the timeout is in [s] of the samples' time.
    void update();               ///< Takes what is new on the ports and hands over what is due.
    void flush();                ///< Hands over all that waits: no more will come.
    /** Of all ports; see AlignedPortBase::notice. */
    std::vector<std::string> notices() const;

private:
    friend class AlignedPortBase;
    AlignedPortBase* earliest() const;
    bool isDue(const AlignedPortBase& candidate);
    void handOver(AlignedPortBase& port);

    std::vector<AlignedPortBase*> ports_;
    types::Time timeout_;
    types::Time newest_ = before_all;  ///< Of all samples.
    types::Time done_ = before_all;    ///< Of the sample handed over last.
};

template <class T>
class AlignedPort final : public AlignedPortBase {
public:
    /** @param capacity of samples that may wait. */
    AlignedPort(StreamAligner& aligner, InputPort<T>& port, std::function<void(const T&)> use, size_t capacity = 256)
        : AlignedPortBase(aligner, port), input_(port), use_(std::move(use)), ring_(capacity) {}

    /** The oldest that waits: the one after those that were handed over. Null when there is none. */
    const T* next() const { return count_ > 0 ? &ring_[first_] : nullptr; }

private:
    static types::Time timeOf(const T& sample) {
        if constexpr (requires { sample->time; })
            return sample->time;
        else
            return sample.time;
    }
    bool empty() const override { return count_ == 0; }
    bool full() const override { return count_ == ring_.size(); }
    types::Time firstTime() const override { return timeOf(ring_[first_]); }
    bool fill() override {
        bool any = false;
        for (; !full() && input_.readNew(sample_); any = true)
            if (accepts(timeOf(sample_))) ring_[(first_ + count_++) % ring_.size()] = std::move(sample_);
        return any;
    }
    void handOver() override {
        const T sample = std::exchange(ring_[first_], T{});
        first_ = (first_ + 1) % ring_.size();
        --count_;
        use_(sample);
    }
    void forget() override { ring_.assign(ring_.size(), T{}), count_ = 0; }

    InputPort<T>& input_;
    std::function<void(const T&)> use_;
    std::vector<T> ring_;
    T sample_{};
    size_t first_ = 0, count_ = 0;
};

}  // namespace insonify::framework
