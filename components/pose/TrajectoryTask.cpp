#include "components/pose/TrajectoryTask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "components/framework/execution/Activity.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::pose {
namespace {

constexpr double max_wait = 3600;  ///< Before the first stamp [s].
constexpr double max_time = 1e9;   ///< Max time of a stamp in the run [s].

/** Returns "12.5 s", or "1403636580.84 s (44.5 years)" for long times. */
std::string spoken(double seconds) {
    const double years = std::abs(seconds) / (365.25 * 86'400);
    return fmt::format("{:.12g} s", seconds) + (years < 0.1 ? "" : fmt::format(" ({:.3g} years)", years));
}

std::string_view getName(TimeUnit unit) { return types::EnumNames<TimeUnit>::names[static_cast<size_t>(unit)]; }

/** Returns why the times of a trajectory cannot be those of a run, with the remedy; empty: they can. */
std::string reasonAgainst(const Trajectory& trajectory, const TrajectoryTimes& times) {
    const auto& stamps = trajectory.stamps();
    const double begin = stamps.front().time, end = stamps.back().time, start = times.start_s.value_or(0);
    const TimeUnit unit = trajectory.timeUnit();
    const std::string of_unit =
        unit == TimeUnit::Seconds ? "" : fmt::format(" (its times are taken as {})", getName(unit));
    if (stamps.size() == 1) return "";  // a fixed pose, at any time
    if (begin > max_wait)
        return fmt::format(
            "begins {} after the start of the run{}; may be up to {:g} s: are its times those of another clock? Set "
            "start: first_pose to start the run at its first pose, or start_s: {:.12g} for all trajectories of that "
            "clock",
            spoken(begin), of_unit, max_wait, begin + start);
    if (times.start_s && end < 0)
        return fmt::format("ends at {:.12g} s{}, before start_s, which is {:.12g} s", end + start, of_unit, start);
    if (std::max(-begin, end) > max_time)
        return fmt::format("has times from {} to {}{}; may be up to {:g} s. Set time_unit if they are ms, us or ns",
                           spoken(begin), spoken(end), of_unit, max_time);
    return "";
}

}  // namespace

void TrajectoryTask::check(types::Diagnostics& diagnostics) const {
    types::Diagnostics of_waypoints;
    config->check(of_waypoints);  // reported already
    if (!of_waypoints.empty()) return;
    try {
        trajectory();
    } catch (const types::ConfigError& error) {
        for (const types::Diagnostic& diagnostic : error.diagnostics())
            diagnostics.push_back(config->file ? types::Diagnostic{"file", diagnostic.text()}
                                               : types::Diagnostic{"waypoints", diagnostic.message});
    }
}

Trajectory TrajectoryTask::trajectory() const {
    Trajectory made = config->file ? Trajectory::fromFile(inputPath(*config->file), config->smooth, config->times,
                                                          config->world_frame)
                                   : Trajectory(config->waypoints, config->smooth, config->times);
    if (const std::string reason = reasonAgainst(made, config->times); !reason.empty())
        throw types::ConfigError(config->file ? inputPath(*config->file).string() : "",
                                 config->file ? "" : name() + ".waypoints", reason);
    return made;
}

double TrajectoryTask::duration() const {
    if (!trajectory_ || trajectory_->stamps().size() == 1) return 0;
    return config->loop ? std::numeric_limits<double>::infinity() : trajectory_->stamps().back().time;
}

bool TrajectoryTask::configureHook() {
    trajectory_ = trajectory();
    motion_.reset();
    if (config->motion) motion_.emplace(*config->motion);
    return true;
}

types::Notices TrajectoryTask::notices() const {
    types::Notices notices;
    if (const std::string wait = waitText(); !wait.empty()) notices.push_back(types::warning(wait));
    if (trajectory_ && !config->times.time_unit && trajectory_->timeUnit() != TimeUnit::Seconds)
        notices.push_back(
            fmt::format("the times of the trajectory are taken as {}, as they are after 1973 in this unit "
                        "(time_unit)",
                        getName(trajectory_->timeUnit())));
    if (const size_t odd = trajectory_ ? trajectory_->oddLengths() : 0; odd > 0)
        notices.push_back(types::warning(fmt::format(
            "{} of {} quaternions of {} have a length that is not 1, and are made 1: are their parts degrees, "
            "or in another order?",
            odd, trajectory_->stamps().size(), *config->file)));
    if (held_ > 0)
        notices.push_back(
            fmt::format("the trajectory ended at {:g} s; {} poses after it are its last one (loop: true repeats it)",
                        duration(), held_.load()));
    return notices;
}

std::string TrajectoryTask::waitText() const {
    const double begin = trajectory_ && trajectory_->stamps().size() > 1 ? trajectory_->stamps().front().time : 0;
    if (!(begin > 0)) return "";
    return fmt::format(
        "the trajectory begins {:g} s after the start of the run, and the vehicle stands at its first pose until "
        "then; start: first_pose begins it with the run",
        begin);
}

bool TrajectoryTask::startHook() {
    finished_ = false;
    held_ = 0;
    return true;
}

void TrajectoryTask::updateHook() {
    const types::Time time = now();
    const types::Time elapsed = environment().elapsed();
    const double seconds = elapsed.seconds();
    types::Pose sample = trajectory_->at(config->loop ? trajectory_->inLoop(seconds) : seconds);
    if (motion_) motion_->move(seconds, sample);
    sample.time = time;
    pose.write(sample);
    if (!config->loop && trajectory_->stamps().size() > 1 && seconds > duration()) ++held_;
    finished_ = !config->loop && (finished_ || isLast(elapsed));
}

bool TrajectoryTask::isLast(types::Time elapsed) {
    const auto& stamps = trajectory_->stamps();
    const types::Time end = types::Time::fromSeconds(stamps.back().time);
    const types::Time next = elapsed + types::Time::fromSeconds(activity().settings().period);
    const types::Time rounding{1};
    return stamps.size() == 1 || elapsed >= end || next > end + rounding;
}

void TrajectoryTask::cleanupHook() { trajectory_.reset(); }

void registerTasks(framework::Registry& registry) {
    registry.add<TrajectoryTask>("pose::TrajectoryTask",
                                 "moves the vehicle along a trajectory from a file or waypoints");
}

}  // namespace insonify::pose
