#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/framework/DynamicPorts.hpp"
#include "components/framework/Offers.hpp"
#include "components/framework/Operation.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/framework/config/StreamNames.hpp"
#include "components/log/PoseSources.hpp"
#include "components/log/Reader.hpp"
#include "types/text/Describe.hpp"

namespace insonify::replay {

struct ReplayConfig {
    std::string file;
    double pace = 1;
    double from = 0;
    bool loop = false;
    std::vector<log::PoseSource> poses = {};
    types::WorldFrame world_frame = types::WorldFrame::Enu;
    std::optional<types::Datum> datum = {};

    static void describe(auto& self, auto& visit) {
        visit({"file", "", "pocolog, MCAP or .db3 file, or the folder of a bag, relative to the deployment"},
              self.file);
        visit({"pace", "1",
               "recorded seconds per second of the wall clock; 0: one instant of the log each cycle; without "
               "effect in lockstep, where simulated time follows the log",
               0, 1e6},
              self.pace);
        visit({"from", "s", "start of the replay, after the log's first stamp", 0, 1e10}, self.from);
        visit({"loop", "", "repeats the log from `from` on, with shifted stamps: time never runs backwards"},
              self.loop);
        visit({"poses", "", "streams of poses that are made from others of the log: from topics, frames of tf, fixes"},
              self.poses);
        visit({"world_frame", "", "axes of poses in messages of other programs; ROS has ENU"}, self.world_frame);
        visit({"datum", "", "the world's origin on the earth, for poses from fixes; absent: the deployment's"},
              self.datum);
    }
};

/** Returns the world's origin on the earth in the deployment that wrote a log, or in the first of its tasks that has
 * one; none: unknown. */
std::optional<types::Datum> recordedDatum(const log::Reader& log);

/** Publishes a log's streams, sample by sample in the order of the file: a source.
 *
 *  Ports: an output for each connection that names a stream of the log, as in `replay.sonar.ping`. Samples keep their
 *  recorded values and stamps; Rock's older beams and scans become pings. `poses` adds streams, see log::addPoses. A
 * logger keeps the streams' recorded names. A sample is due at its world time, or with its predecessor in the file if
 * that is later. Where the logger's clock was set back, time continues: see log::LoggerClock. `from`, `seek` and the
 * position in the log are of that time. In lockstep, simulated time starts at the first sample and advances from one
 * sample to the next. In realtime the task keeps `pace`, checking every millisecond unless its activity has a period.
 * All tasks of the deployment then read the log's time, at that pace, instead of the wall clock.
 *
 *  In realtime the log's time can be paused and stepped; in lockstep the deployment's time can.
 *
 *  After a jump (`loop`, `seek`) time continues: the stamps of all samples are shifted so that the next sample follows
 *  after the interval between the two samples before it, in realtime not before now.
 *
 *  An incomplete log is played up to its last complete block, with a notice. Streams without a connection or of an
 *  unknown type are listed in notices. A sample that cannot be decoded causes Exception. */
class ReplayTask final : public framework::TaskContext,
                         public framework::ClockSource,
                         public framework::StandIn,
                         public framework::Player {
public:
    using TaskContext::TaskContext;

    framework::Properties<ReplayConfig> config{this};
    framework::Operation<void(double)> seek{this, "seek",
                                            "jumps to this time after the log's first stamp, within the log [s]",
                                            [this](double seconds) { seekTo(seconds); }};
    framework::Operation<void(bool)> pause{this, "pause", "in realtime: true pauses the log's time, false resumes it",
                                           [this](bool on) { setPaused(on); }};
    framework::Operation<void()> step{this, "step", "while paused: plays the next instant of the log",
                                      [this] { playNext(); }};

    /** Throws ConfigError when the log cannot be read or has no such stream; null when the stream's type is unknown. */
    framework::OutputPortBase* makeOutput(const std::string& stream) override;
    void check(types::Diagnostics& diagnostics) const override;
    types::Notices notices() const override;
    bool finished() const override { return finished_; }
    std::optional<types::Time> nextTime() const override;
    /** Returns the world time in the log of the next sample, of all streams or one; none: there is no more. Between
     *  instants. */
    std::optional<types::Time> nextStamp(const std::string& stream = "") const;
    std::function<types::Time()> clock(std::function<types::Time()> wall) override;
    std::string getStream(const std::string& port) const override;
    std::string getModel(const std::string& port) const override;
    /** Returns the position in the log of the last sample played, without steps of the logger's clock. */
    std::optional<types::Playback> playback() const override;

private:
    /** The object that samples of a stream are read into. */
    template <class T>
    struct Room {
        framework::SamplePool<T> pool;  ///< For types passed by reference.
        T sample{};                     ///< For types passed by value.
    };
    using Outputs = framework::DynamicOutputs<types::SampleTypes, Room>;

    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    /** Reports a stream of poses or points that is played and counts from another datum than the world's. */
    void checkDatum(const log::Reader& log, types::Diagnostics& diagnostics) const;
    /** Returns the log with the streams of `poses`, and what there is to say of these. Throws ConfigError. */
    std::pair<std::unique_ptr<log::Reader>, types::Notices> opened() const;
    void open();
    void rewind();
    /** Jumps to this time after the log's first stamp [s]; throws outside of the log. */
    void seekTo(double seconds);
    void jump(double seconds);
    /** Returns the index of the first sample from an index on that has an output. */
    size_t withOutput(size_t index) const;
    void noteInstant();
    void setPaused(bool on);
    void playNext();
    /** Plays the samples due until then. */
    void play(types::Time until);
    types::Time logTime() const;
    /** Advances to the next sample that has an output, at `next_` or after it. */
    void settle();
    /** Returns the world time of the log up to which samples are due now. */
    types::Time due();

    std::unique_ptr<log::Reader> log_;
    types::Notices pose_notices_;
    std::string gap_text_;  ///< Warning of a long gap between two samples; empty: there is none.
    log::LoggerClock clock_;
    Outputs outputs_{this};
    std::vector<Outputs::Output*> by_stream_;  ///< The output of each stream of the log; null without a connection.
    size_t next_ = 0;                          ///< Index into the log's samples.
    types::Time next_time_;                    ///< When that sample is due, on the log's clock.
    types::Time shift_;                        ///< Shift of the stamps after jumps.
    types::Time gap_{1'000'000};               ///< Between the last two instants.
    types::Time pause_;                        ///< In addition to `gap_`, before the next instant, after a late jump.
    std::atomic<double> pace_{1};              ///< Other threads read the clock, too.
    std::function<types::Time()> wall_;        ///< In realtime.
    /** Start of the log's time on the wall clock, without pauses; negative: it stands, -1 - the time since its start.
     *  The tasks of the deployment read it with every look at the clock, without a lock. */
    std::atomic<int64_t> clock_us_{-1};
    std::atomic<bool> is_paused_{false};
    std::atomic<int64_t> first_us_{0};   ///< The instant at which the replay starts, on the log's clock.
    std::atomic<int64_t> played_us_{0};  ///< The instant being played; 0: none yet.
    std::atomic<int64_t> at_us_{0};      ///< The last sample played, after the log's first.
    std::atomic<double> span_s_{-1};     ///< Span of the log; negative: the log is not open.
    std::atomic<bool> finished_{false};
};

/** Registers the tasks of this folder. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::replay
