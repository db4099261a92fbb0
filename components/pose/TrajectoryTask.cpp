#include "components/pose/TrajectoryTask.hpp"

#include <fmt/format.h>

#include "components/framework/Activity.hpp"

namespace insonify::pose {

void TrajectoryTask::check(types::Diagnostics& diagnostics) const {
    if (!config->file) return;
    try {
        Trajectory::fromCsv(inputPath(*config->file));
    } catch (const types::ConfigError& error) {
        for (const types::Diagnostic& diagnostic : error.diagnostics())
            diagnostics.push_back({"file", diagnostic.text()});
    }
}

Trajectory TrajectoryTask::trajectory() const {
    return config->file ? Trajectory::fromCsv(inputPath(*config->file), config->smooth)
                        : Trajectory(config->waypoints, config->smooth);
}

bool TrajectoryTask::configureHook() {
    trajectory_ = trajectory();
    motion_.reset();
    if (config->motion) motion_.emplace(*config->motion);
    return true;
}

std::vector<std::string> TrajectoryTask::notices() const {
    std::vector<std::string> notices;
    if (const size_t odd = trajectory_ ? trajectory_->oddLengths() : 0; odd > 0)
        notices.push_back(fmt::format(
            "Warning: {} of {} quaternions of {} have a length that is not 1, and are made 1: are their parts degrees, "
            "or in another order?",
            odd, trajectory_->stamps().size(), *config->file));
    if (held_ > 0)
        notices.push_back(
            fmt::format("the trajectory ended at {:g} s; {} poses after it are its last one (loop: true repeats it)",
                        duration(), held_.load()));
    return notices;
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
