#include "components/dataset/Samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "components/dataset/Placement.hpp"
#include "types/samples/Pose.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"
#include "types/text/Hash.hpp"

namespace insonify::dataset {
namespace {

constexpr uint64_t pose_stream = 0x706f7365, setting_stream = 0x73657474696e6700, noise_stream = 0x6e6f697365,
                   motion_stream = 0x6d6f74696f6e00, selection_stream = 0x73656c656374;

/** Returns the coordinates of a pose of a grid. */
std::vector<double> gridded(const PoseAxes& axes, uint64_t pose) {
    std::vector<const Axis*> all;
    PoseAxes::forEach(axes, [&](const char*, const char*, const Axis& axis) { all.push_back(&axis); });
    std::vector<double> values(all.size());
    for (size_t i = all.size(); i-- > 0; pose /= all[i]->stepCount())
        values[i] = all[i]->step(pose % all[i]->stepCount());
    return values;
}

/** Returns the coordinates of a drawn pose. */
std::vector<double> drawn(const PoseAxes& axes, uint64_t seed, uint64_t pose) {
    std::vector<double> values;
    PoseAxes::forEach(axes, [&](const char*, const char*, const Axis& axis) {
        values.push_back(axis.draw(types::hashed(seed, pose, pose_stream + values.size())));
    });
    return values;
}

}  // namespace

types::Diagnostics findUnmatched(const Sweep& sweep, const std::vector<std::string>& patterns,
                                 const std::vector<std::string>& known, const std::string& what, int line, int column,
                                 const char* where) {
    types::Diagnostics diagnostics;
    for (size_t i = 0; i < patterns.size(); ++i)
        if (std::ranges::none_of(known, [&](const std::string& name) { return matches(patterns[i], name); }))
            diagnostics.push_back({fmt::format("{}[{}]", what, i),
                                   fmt::format("is {}, which is no name in {}; {}insonify scene lists them",
                                               patterns[i], where, types::didYouMean(patterns[i], known)),
                                   sweep.file, line, column});
    return diagnostics;
}

std::vector<std::string> resolve(const Sweep& sweep, const std::vector<std::string>& patterns,
                                 const std::vector<std::string>& known, const std::string& what, int line, int column,
                                 const char* where) {
    if (types::Diagnostics wrong = findUnmatched(sweep, patterns, known, what, line, column, where); !wrong.empty())
        throw types::ConfigError(std::move(wrong));
    std::vector<std::string> names;
    for (const std::string& pattern : patterns)
        for (const std::string& name : known)
            if (matches(pattern, name) && std::ranges::count(names, name) == 0) names.push_back(name);
    return names;
}

uint64_t word(const Sweep& sweep, uint64_t index, size_t number) {
    return types::hashed(sweep.seed, index, setting_stream + number);
}

Selection::Selection(uint64_t total, uint64_t count, uint64_t seed) : size_(count) {
    if (count == 0 || count > total)
        throw types::ConfigError("", "--count",
                                 fmt::format("is {}; may be 1 to {}, the number of samples of the sweep (for more "
                                             "raise its poses, or the count of random ones)",
                                             count, total));
    if (count > max_drawn)
        throw types::ConfigError("", "--count", fmt::format("is {}; at most {} are drawn", count, max_drawn));
    // Fisher-Yates: the numbers that a step has moved, by place
    std::unordered_map<uint64_t, uint64_t> moved;
    const auto numberAt = [&](uint64_t place) {
        const auto found = moved.find(place);
        return found == moved.end() ? place : found->second;
    };
    for (uint64_t step = 0; step < count; ++step) {
        const uint64_t place = step + types::hashed(seed, step, selection_stream) % (total - step);
        drawn_.push_back(numberAt(place));
        moved[place] = numberAt(step);
    }
    std::ranges::sort(drawn_);
}

Samples::Samples(const Sweep& sweep, std::vector<std::vector<TimedPose>> trajectory, std::vector<SceneParts> scenes)
    : sweep_(sweep), trajectory_(std::move(trajectory)), scenes_(std::move(scenes)) {
    poses_ = sweep.grid ? sweep.grid->gridSize() : sweep.random ? sweep.random_count : trajectory_.size();
    for (const Setting& setting : sweep.settings)
        settings_ = std::min<uint64_t>(settings_ * setting.values.size(), 1'000'000'000'000);
    const double all = static_cast<double>(poses_) * static_cast<double>(settings_) * double(sweep.scenes.size());
    if (all > static_cast<double>(max_samples))
        throw types::ConfigError(sweep.file, "",
                                 fmt::format("makes {:g} samples; at most {} go into one data set", all, max_samples));
    count_ = poses_ * settings_ * sweep.scenes.size();
    for (size_t group = 0; group < sweep.objects.size(); ++group) refuseUnmatched(group);
    names_.resize(scenes_.size());
    for (size_t scene = 0; scene < scenes_.size(); ++scene)
        for (size_t group = 0; group < sweep.objects.size(); ++group) names_[scene].push_back(getNames(scene, group));
    for (size_t group = 0; group < sweep.objects.size(); ++group) refuseTooMany(group);
}

void Samples::refuseTooMany(size_t number) const {
    const ObjectGroup& group = sweep_.objects[number];
    size_t available = 0;
    for (const auto& names : names_) available = std::max(available, names[number].size());
    if (!group.count.empty() && group.count[1] > available)
        throw types::ConfigError(
            {{fmt::format("objects[{}].count", number),
              fmt::format("is [{}, {}], but only {} objects match names", group.count[0], group.count[1], available),
              sweep_.file, group.line, group.column}});
}

void Samples::refuseUnmatched(size_t number) const {
    const ObjectGroup& group = sweep_.objects[number];
    std::vector<std::string> placeable, nodes;
    for (const SceneParts& scene : scenes_) {
        for (const auto& [name, each] : scene.placeables) placeable.push_back(name);
        nodes.insert(nodes.end(), scene.nodes.begin(), scene.nodes.end());
    }
    const char* where = scenes_.size() > 1 ? "any of the scenes" : "the scene";
    const std::string path = fmt::format("objects[{}].", number);
    resolve(sweep_, group.names, placeable, path + "names", group.line, group.column, where);
    resolve(sweep_, group.avoid, nodes, path + "avoid", group.line, group.column, where);
}

std::vector<std::string> Samples::getNames(size_t scene, size_t number) const {
    const ObjectGroup& group = sweep_.objects[number];
    std::vector<std::string> names;
    for (const std::string& pattern : group.names)
        for (const auto& [name, placeable] : scenes_[scene].placeables)
            if (matches(pattern, name) && std::ranges::count(names, name) == 0) names.push_back(name);
    const std::string path = fmt::format("objects[{}].names", number);
    for (size_t before = 0; before < number; ++before)
        for (const std::string& name : names_[scene][before])
            if (std::ranges::count(names, name) > 0)
                throw types::ConfigError(
                    {{path, "places " + name + " for the second time", sweep_.file, group.line, group.column}});
    return names;
}

std::vector<std::string> Samples::getObjects(size_t scene) const {
    std::vector<std::string> all;
    for (const auto& names : names_[scene]) all.insert(all.end(), names.begin(), names.end());
    return all;
}

std::vector<std::pair<std::string, std::string>> Samples::getSettings(size_t setting) const {
    std::vector<std::pair<std::string, std::string>> chosen;
    for (auto each = sweep_.settings.rbegin(); each != sweep_.settings.rend(); ++each) {
        chosen.emplace_back(each->property, each->values[setting % each->values.size()].yaml);
        setting /= each->values.size();
    }
    std::ranges::reverse(chosen);
    return chosen;
}

std::vector<TimedPose> Samples::getRun(uint64_t pose) const {
    if (sweep_.trajectory) return trajectory_[pose];
    const std::vector<double> values =
        sweep_.grid ? gridded(*sweep_.grid, pose) : drawn(*sweep_.random, sweep_.seed, pose);
    const types::Mount mount{{values[0], values[1], values[2]}, values[3], values[4], values[5]};
    types::Pose at;
    at.source_frame = "body";
    at.target_frame = "world";
    at.position = mount.position;
    at.orientation = mount.orientation();
    std::vector<TimedPose> run{{0, at}};
    if (!sweep_.lines) return run;
    const LinesConfig& lines = *sweep_.lines;
    std::optional<pose::SeaMotion> motion;
    if (pose::SeaMotionConfig own = lines.motion.value_or(pose::SeaMotionConfig{}); lines.motion) {
        own.seed = static_cast<uint32_t>(types::hashed(sweep_.seed, pose, motion_stream + own.seed));
        motion.emplace(own);
    }
    const double heading = types::radians(mount.yaw_deg);
    run.clear();
    for (uint32_t i = 0; i < lines.count; ++i) {
        TimedPose& here = run.emplace_back(lines.period * i, at);
        here.at.position += *lines.speed * here.time * glm::dvec3(std::cos(heading), std::sin(heading), 0);
        if (motion) motion->move(here.time, here.at);
    }
    return run;
}

std::vector<PlacedObject> Samples::place(size_t scene, uint64_t pose, const types::Pose& vehicle) const {
    Placement placement(sweep_, scenes_[scene], pose, vehicle);
    for (size_t group = 0; group < names_[scene].size(); ++group) placement.add(group, names_[scene][group]);
    return placement.objects();
}

Sample Samples::at(uint64_t index) const {
    Sample sample;
    sample.index = index;
    sample.pose = index % poses_;
    sample.setting = index / poses_ % settings_;
    sample.scene = index / poses_ / settings_;
    sample.run = getRun(sample.pose);
    sample.objects = place(sample.scene, sample.pose, sample.run.front().at);
    sample.settings = getSettings(sample.setting);
    for (size_t i = 0; i < sweep_.drawn.size(); ++i)
        sample.settings.emplace_back(sweep_.drawn[i].property, sweep_.drawn[i].draw(word(sweep_, index, i)));
    sample.seed = types::hashed(sweep_.seed, index, noise_stream) | 1;
    sample.part = sweep_.split.of(sweep_.seed, sample.scene * poses_ + sample.pose);
    return sample;
}

}  // namespace insonify::dataset
