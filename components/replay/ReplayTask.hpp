#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/DynamicPorts.hpp"
#include "components/framework/Offers.hpp"
#include "components/framework/Operation.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/framework/StreamNames.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/log/Reader.hpp"
#include "types/Describe.hpp"

namespace insonify::replay {

struct ReplayConfig {
    std::string file;
    double pace = 1;
    double from = 0;
    bool loop = false;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"file", "", "pocolog or MCAP file, relative to the deployment"}, self.file);
        visit(Field{"pace", "1",
                    "recorded seconds per second of the wall clock; 0: one instant of the log each cycle; without "
                    "effect in lockstep, where simulated time follows the log",
                    0, 1e6},
              self.pace);
        visit(Field{"from", "s", "after the log's first stamp, where playing starts", 0, 1e9}, self.from);
        visit(
            Field{"loop", "", "at its end the log goes on from there again, its stamps moved on: time never goes back"},
            self.loop);
    }
};

/** Publishes a log's streams again, sample by sample in the order of the file: a source.
 *
 *  Ports: an output for each connection that names a stream of the log, as in `replay.sonar.ping`; the samples are
 *  the recorded ones, stamps and all; Rock's older beams and scans come as pings. A logger names them as they were. A
 * sample is due at its world time, or with the one before it in the file if that is later. In lockstep simulated time
 * starts at the first sample and goes from one to the next; in realtime the task keeps `pace`, checking every
 * millisecond unless its activity has a period, and all tasks of the deployment read the log's time, at that pace, in
 * place of the wall clock.
 *
 *  In realtime the log's time can be paused and stepped; in lockstep the deployment's is.
 *
 *  After a jump (`loop`, `seek`) time goes on: the stamps of all samples are moved by so much that the next sample
 *  comes as long after the one before as that came after its own predecessor; in realtime not before now.
 *
 *  A log that was cut off plays up to its last whole block, with a notice; streams that nothing is connected to, or
 *  whose type is not known, are listed in notices. A sample that cannot be decoded ends in Exception. */
class ReplayTask final : public framework::TaskContext,
                         public framework::ClockSource,
                         public framework::StandIn,
                         public framework::Player {
public:
    using TaskContext::TaskContext;

    framework::Properties<ReplayConfig> config{this};
    framework::Operation<void(double)> seek{this, "seek",
                                            "goes on so many seconds after the log's first stamp, within the log [s]",
                                            [this](double seconds) { seekTo(seconds); }};
    framework::Operation<void(bool)> pause{this, "pause",
                                           "in realtime: true lets the log's time stand still, false go on",
                                           [this](bool on) { setPaused(on); }};
    framework::Operation<void()> step{this, "step", "while paused: plays the next instant of the log",
                                      [this] { playNext(); }};

    /** Throws ConfigError when the log cannot be read or has no such stream; null when its type is not known. */
    framework::OutputPortBase* makeOutput(const std::string& stream) override;
    void check(types::Diagnostics& diagnostics) const override;
    std::vector<std::string> notices() const override;
    bool finished() const override { return finished_; }
    std::optional<types::Time> nextTime() const override;
    /** World time in the log of the next sample, of all or of one stream; none: there is no more. Between instants. */
    std::optional<types::Time> nextStamp(const std::string& stream = "") const;
    std::function<types::Time()> clock(std::function<types::Time()> wall) override;
    std::string streamOf(const std::string& port) const override;
    std::string modelOf(const std::string& port) const override;
    /** Where the sample that was played last lies in the log, by its recorded stamp. */
    std::optional<types::Playback> playback() const override;

private:
    /** Where samples of a stream are read into. */
    template <class T>
    struct Room {
        framework::SamplePool<T> pool;  ///< For what travels by reference.
        T sample{};                     ///< For what travels by value.
    };
    using Outputs = framework::DynamicOutputs<types::SampleTypes, Room>;

    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void open();
    void rewind();
    /** Goes on so long after the log's first stamp; refuses what is outside of the log. */
    void seekTo(double seconds);
    void jump(double seconds);
    /** Index of the first sample so long after the log's first stamp; of the first from there on with an output. */
    size_t indexAt(double seconds) const;
    size_t withOutput(size_t index) const;
    void noteInstant();
    void setPaused(bool on);
    void playNext();
    /** What is due until then. */
    void play(types::Time until);
    types::Time logTime() const;
    /** Moves on to the next sample that has an output, at `next_` or after it. */
    void settle();
    /** World time of the log up to which samples are due now. */
    types::Time due();

    std::unique_ptr<log::Reader> log_;
    Outputs outputs_{this};
    std::vector<Outputs::Output*> by_stream_;  ///< The output of each stream of the log; null without a connection.
    size_t next_ = 0;                          ///< Index into the log's samples.
    types::Time next_time_;                    ///< When it is due, on the log's clock.
    types::Time shift_;                        ///< By which stamps are moved after jumps.
    types::Time gap_{1'000'000};               ///< Between the last two instants.
    types::Time pause_;                        ///< Beyond `gap_`, before the next instant, after a late jump.
    std::atomic<double> pace_{1};              ///< Others read the clock, too.
    std::function<types::Time()> wall_;        ///< In realtime.
    mutable std::mutex clock_mutex_;           ///< Of the next two, which others read through the clock.
    int64_t started_us_ = 0;                   ///< On the wall clock, pauses left out; 0: not yet.
    int64_t paused_us_ = 0;                    ///< Since when the log's time stands still; 0: it does not.
    std::atomic<int64_t> first_us_{0};         ///< The instant at which playing starts, on the log's clock.
    std::atomic<int64_t> played_us_{0};        ///< The instant that is played; 0: none yet.
    std::atomic<int64_t> at_us_{0};            ///< The sample that was played last, after the log's first.
    std::atomic<double> span_s_{-1};           ///< Of the log; negative: it is not open.
    std::atomic<bool> finished_{false};
};

/** Makes the tasks of this folder known to deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::replay
