#include "components/dataset/Samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numeric>
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
    poses_ = countPoses(sweep, trajectory_);
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

uint64_t countPoses(const Sweep& sweep, const std::vector<std::vector<TimedPose>>& trajectory) {
    return sweep.grid ? sweep.grid->gridSize() : sweep.random ? sweep.random_count : trajectory.size();
}

std::vector<TimedPose> makeRun(const Sweep& sweep, const std::vector<std::vector<TimedPose>>& trajectory,
                               uint64_t pose) {
    if (sweep.trajectory) return trajectory[pose];
    const std::vector<double> values = sweep.grid ? gridded(*sweep.grid, pose) : drawn(*sweep.random, sweep.seed, pose);
    const types::Mount mount{{values[0], values[1], values[2]}, values[3], values[4], values[5]};
    types::Pose at;
    at.source_frame = "body";
    at.target_frame = "world";
    at.position = mount.position;
    at.orientation = mount.orientation();
    std::vector<TimedPose> run{{0, at}};
    if (!sweep.lines) return run;
    const LinesConfig& lines = *sweep.lines;
    std::optional<pose::SeaMotion> motion;
    if (pose::SeaMotionConfig own = lines.motion.value_or(pose::SeaMotionConfig{}); lines.motion) {
        own.seed = static_cast<uint32_t>(types::hashed(sweep.seed, pose, motion_stream + own.seed));
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
    sample.run = makeRun(sweep_, trajectory_, sample.pose);
    sample.objects = place(sample.scene, sample.pose, sample.run.front().at);
    sample.settings = getSettings(sample.setting);
    for (size_t i = 0; i < sweep_.drawn.size(); ++i)
        sample.settings.emplace_back(sweep_.drawn[i].property, sweep_.drawn[i].draw(word(sweep_, index, i)));
    sample.seed = types::hashed(sweep_.seed, index, noise_stream) | 1;
    sample.part = getPart(index);
    return sample;
}

Part Samples::getPart(uint64_t index) const {
    const uint64_t scene = index / poses_ / settings_;
    return sweep_.split.of(sweep_.seed, scene * poses_ + index % poses_);
}

std::string describeEmptyParts(const Sweep& sweep, const Selection& selection, const Samples& samples) {
    const double shares[] = {sweep.split.train, sweep.split.val, sweep.split.test};
    uint64_t counts[] = {0, 0, 0};
    const auto isMissing = [&](size_t part) { return shares[part] > 0 && counts[part] == 0; };
    for (uint64_t i = 0; i < selection.size() && (isMissing(0) || isMissing(1) || isMissing(2)); ++i)
        ++counts[static_cast<size_t>(samples.getPart(selection[i]))];
    std::string missing;
    for (size_t part = 0; part < 3; ++part)
        if (isMissing(part))
            missing += fmt::format("{}{} (share {:g})", missing.empty() ? "" : ", nor in ",
                                   types::EnumNames<Part>::names[part], shares[part]);
    if (missing.empty()) return "";
    return fmt::format(
        "split: none of {} samples is in {}; parts are drawn at random: use more samples or another seed",
        selection.size(), missing);
}

namespace {

/** The nearest surfaces straight above and below a position. */
struct Column {
    double above = std::numeric_limits<double>::infinity(), below = -above;  ///< Heights [m].
    bool above_faces_up = false, below_faces_up = false;

    /** Whether the position is behind the surface above it, with none in front of it below. */
    bool isBuried() const { return above_faces_up && !below_faces_up; }
    void add(double height, double at, bool faces_up) {
        if (height > at && height < above) above = height, above_faces_up = faces_up;
        if (height <= at && height > below) below = height, below_faces_up = faces_up;
    }
};

/** Returns the column of each position. Each triangle visits the positions in its span of x. */
std::vector<Column> findColumns(const std::vector<glm::dvec3>& positions, const types::Geometry& geometry) {
    std::vector<size_t> order(positions.size());
    std::iota(order.begin(), order.end(), size_t{0});
    const auto byX = [&](size_t i) { return positions[i].x; };
    std::ranges::sort(order, {}, byX);
    std::vector<Column> columns(positions.size());
    for (const types::Object& object : geometry.objects) {
        const types::Mesh& mesh = geometry.meshes[static_cast<size_t>(object.mesh)];
        const double hand = glm::determinant(glm::dmat3(object.world_from_object));
        for (size_t k = 0; k + 2 < mesh.indices.size(); k += 3) {
            std::array<glm::dvec3, 3> corners;
            for (size_t i = 0; i < 3; ++i)
                corners[i] = object.world_from_object * glm::dvec4(mesh.positions[mesh.indices[k + i]], 1);
            const auto& [a, b, c] = corners;
            const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
            const double high = std::max({a.x, b.x, c.x});
            auto at = std::ranges::lower_bound(order, std::min({a.x, b.x, c.x}), {}, byX);
            for (; area != 0 && at != order.end() && positions[*at].x <= high; ++at)
                if (const auto height = highestAt({corners}, positions[*at].x, positions[*at].y))
                    columns[*at].add(*height, positions[*at].z, (area > 0) == (hand > 0));
        }
    }
    return columns;
}

double computeDistance(const types::Extent& box, const glm::dvec3& at) {
    return glm::length(glm::max(glm::max(box.low - at, at - box.high), glm::dvec3(0)));
}

}  // namespace

std::vector<std::string> describeOddPoses(const std::vector<glm::dvec3>& positions, const Surroundings& around) {
    std::vector<std::string> all;
    const auto describe = [&](const std::string& what, auto&& isOdd) {
        size_t count = 0, first = 0;
        for (size_t i = 0; i < positions.size(); ++i)
            if (isOdd(i) && count++ == 0) first = i;
        const glm::dvec3 at = positions.empty() ? glm::dvec3(0) : positions[first];
        if (count == 0) return;
        const std::string each = around.step > 1 ? fmt::format(" (one in {} of the sweep)", around.step) : "";
        all.push_back(
            fmt::format("{} of {} poses{}: the sonar is {}; the first is pose {}, at [{:.4g}, {:.4g}, {:.4g}]", count,
                        positions.size(), each, what, first * around.step, at.x, at.y, at.z));
    };
    if (const auto surface = around.water_surface)
        describe(fmt::format("above the water surface, at z {:g} m (z is up: depths are negative)", *surface),
                 [&](size_t i) { return positions[i].z > *surface; });
    if (!around.geometry || around.geometry->objects.empty()) return all;
    const types::Extent box = types::getExtent(*around.geometry);
    describe(fmt::format("farther from the scene than its range of {:g} m", around.range),
             [&](size_t i) { return computeDistance(box, positions[i]) > around.range; });
    const std::vector<Column> columns = findColumns(positions, *around.geometry);
    describe("below the floor or inside of a body: the surface above it faces up, and none below it does",
             [&](size_t i) { return columns[i].isBuried(); });
    return all;
}

}  // namespace insonify::dataset
