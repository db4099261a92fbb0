#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/Port.hpp"
#include "types/Time.hpp"
#include "types/text/Notice.hpp"

namespace insonify::framework {

class StreamAligner;

/** The time of a sample that has not arrived yet. */
constexpr types::Time before_all{std::numeric_limits<int64_t>::min()};

/** The place of a sample in the order: by its stamp, in rounds that begin where stamps go back by more than
 *  types::max_lateness, as a recording that repeats or after a clock was set back. */
struct AlignedMoment {
    uint64_t round = 0;
    types::Time time = before_all;
    friend auto operator<=>(const AlignedMoment&, const AlignedMoment&) = default;
};

/** The untyped part of a StreamAligner's port. */
class AlignedPortBase {
public:
    /** Counts since the aligner was last cleared [samples]. */
    struct Counts {
        uint64_t received = 0;
        uint64_t late = 0;     ///< Dropped: older than a sample handed over, or than the port's previous one.
        uint64_t awaited = 0;  ///< Samples of other ports handed over without this port's, after the timeout.
    };
    AlignedPortBase(StreamAligner& aligner, const InputPortBase& port);
    virtual ~AlignedPortBase() = default;
    AlignedPortBase(const AlignedPortBase&) = delete;
    AlignedPortBase& operator=(const AlignedPortBase&) = delete;

    const Counts& counts() const { return counts_; }
    /** Returns a notice of dropped samples and timeouts, "pose: 3 of 120 samples came too late and were dropped";
     *  empty: nothing. */
    std::string notice() const;

    // For its aligner only.
    virtual bool empty() const = 0;
    virtual bool full() const = 0;
    virtual AlignedMoment first() const = 0;          ///< Of the oldest waiting sample; there must be one.
    virtual bool fill() = 0;                          ///< Takes new samples while there is capacity; false: none.
    virtual void handOver() = 0;                      ///< Hands over the oldest waiting sample.
    void clear();                                     ///< Forgets samples and counts.
    bool holdsUp(const AlignedMoment& moment) const;  ///< A sample before that moment may still arrive.
    void noteAwaited() { ++counts_.awaited; }

protected:
    virtual void forget() = 0;  ///< Drops the waiting samples.
    /** Records a sample's time; returns whether it is in the order of time. */
    bool accepts(types::Time time);
    uint64_t round() const { return last_.round; }  ///< Of the sample that was accepted last.

private:
    AlignedMoment alignMoment(types::Time time) const;

    StreamAligner& aligner_;
    const InputPortBase& port_;
    Counts counts_;
    AlignedMoment last_;  ///< The newest sample.
    /** Stamp of the first dropped sample of a round that is over. A port whose stamps did not go back with the others
     *  takes part again after the timeout. */
    std::optional<types::Time> behind_since_;
};

/** Hands over the samples of several ports in the order of their stamps, regardless of their order of arrival, as
 *  Rock's stream aligner does.
 *
 *      framework::StreamAligner aligner_;
 *      framework::AlignedPort<types::Pose> poses_{aligner_, pose, [this](const types::Pose& sample) { ... }};
 *      framework::AlignedPort<types::ImagePtr> images_{aligner_, image, [this](const types::ImagePtr& sample) { ... }};
 *      bool startHook() override { return aligner_.clear(1.0), true; }
 *      void updateHook() override { aligner_.update(); }
 *
 *  A sample waits until every other port has a sample that is as late or later, so that no earlier sample can arrive.
 *  It stops waiting once some port has a sample later by `timeout`, or its own buffer is full. A silent port thus
 *  delays the others by at most `timeout`; the samples that went on without it are counted. Samples of equal time are
 *  handed over in the order in which their ports were declared. Late samples are dropped and counted. When a port's
 *  stamps go back by more than types::max_lateness, its samples wait until those of the other ports do, or for the
 *  timeout, and the order begins anew. No clock is read: the same samples in the same order give the same result. */
class StreamAligner {
public:
    void clear(double timeout);  ///< Forgets samples and counts; the timeout is in [s] of the samples' time.
    void update();               ///< Takes new samples of the ports and hands over those that are due.
    void flush();                ///< Hands over all waiting samples, when no more will arrive.
    /** Returns the notices of all ports; see AlignedPortBase::notice. */
    types::Notices notices() const;

    // For its ports only.
    void enlist(AlignedPortBase* port) { ports_.push_back(port); }
    const AlignedMoment& handedOver() const { return done_; }  ///< Of the sample handed over last.
    types::Time timeout() const { return timeout_; }
    void noteTaken(const AlignedMoment& moment);  ///< A port has taken a sample of that moment.

private:
    AlignedPortBase* earliest() const;
    bool isDue(const AlignedPortBase& candidate);
    void handOver(AlignedPortBase& port);

    std::vector<AlignedPortBase*> ports_;
    types::Time timeout_;
    AlignedMoment newest_;                  ///< Of all samples.
    AlignedMoment done_;                    ///< Of the sample handed over last.
    types::Time round_began_ = before_all;  ///< Stamp of the first sample of the newest round.
};

template <class T>
class AlignedPort final : public AlignedPortBase {
public:
    /** @param capacity max number of waiting samples */
    AlignedPort(StreamAligner& aligner, InputPort<T>& port, std::function<void(const T&)> use, size_t capacity = 256)
        : AlignedPortBase(aligner, port), input_(port), use_(std::move(use)), ring_(capacity) {}

    /** The oldest waiting sample, next to be handed over. Null when there is none. */
    const T* next() const { return count_ > 0 ? &ring_[first_].sample : nullptr; }

private:
    static types::Time getTime(const T& sample) {
        if constexpr (requires { sample->time; })
            return sample->time;
        else
            return sample.time;
    }
    bool empty() const override { return count_ == 0; }
    bool full() const override { return count_ == ring_.size(); }
    AlignedMoment first() const override { return {ring_[first_].round, getTime(ring_[first_].sample)}; }
    bool fill() override {
        bool any = false;
        for (; !full() && input_.readNew(sample_); any = true)
            if (accepts(getTime(sample_))) ring_[(first_ + count_++) % ring_.size()] = {std::move(sample_), round()};
        return any;
    }
    void handOver() override {
        const T sample = std::exchange(ring_[first_], {}).sample;
        first_ = (first_ + 1) % ring_.size();
        --count_;
        use_(sample);
    }
    void forget() override { ring_.assign(ring_.size(), {}), count_ = 0; }

    struct Waiting {
        T sample{};
        uint64_t round = 0;
    };
    InputPort<T>& input_;
    std::function<void(const T&)> use_;
    std::vector<Waiting> ring_;
    T sample_{};
    size_t first_ = 0, count_ = 0;
};

}  // namespace insonify::framework
