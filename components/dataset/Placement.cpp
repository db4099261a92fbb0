#include "components/dataset/Placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "types/samples/Pose.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Hash.hpp"

namespace insonify::dataset {
namespace {

constexpr uint64_t tries = 1000, words_per_try = 4;
constexpr uint64_t stream = 0x706c6163650000;        ///< Random words; numbers of groups and objects are added.
constexpr uint64_t tilt_words = uint64_t{1} << 40;   ///< First word of roll and pitch, after all others.
constexpr uint64_t scale_words = uint64_t{1} << 41;  ///< First word of scales.
constexpr double out_of_range = 1e5;                 ///< Depth below its place of an absent object [m].

/** Returns radius and lowest point of a turned object, without its points. */
Placeable turned(const Placeable& object, const glm::dquat& turn) {
    Placeable result;
    result.filed = object.filed, result.low = std::numeric_limits<double>::infinity();
    for (const glm::dvec3 point : object.points) {
        const glm::dvec3 at = turn * point;
        result.radius = std::max(result.radius, std::hypot(at.x, at.y));
        result.low = std::min(result.low, at.z);
    }
    return result;
}

double computeHeading(const types::Pose& pose) {
    const glm::dvec3 ahead = pose.orientation * glm::dvec3(1, 0, 0);
    return std::atan2(ahead.y, ahead.x);
}

double distanceTo(const types::Extent& box, double x, double y) {
    const double dx = std::max({box.low.x - x, 0.0, x - box.high.x}),
                 dy = std::max({box.low.y - y, 0.0, y - box.high.y});
    return std::hypot(dx, dy);
}

}  // namespace

std::optional<double> highestAt(const std::vector<std::array<glm::dvec3, 3>>& triangles, double x, double y) {
    std::optional<double> highest;
    for (const auto& [a, b, c] : triangles) {
        const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
        if (area == 0) continue;
        const double v = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / area;
        const double w = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / area;
        if (v < 0 || w < 0 || v + w > 1) continue;
        const double z = a.z + v * (b.z - a.z) + w * (c.z - a.z);
        if (!highest || z > *highest) highest = z;
    }
    return highest;
}

Placement::Placement(const Sweep& sweep, const SceneParts& scene, uint64_t pose, const types::Pose& vehicle)
    : sweep_(sweep), scene_(scene), pose_(pose), vehicle_(vehicle) {
    taken_.push_back({vehicle.position.x, vehicle.position.y, 0});
}

double Placement::between(const std::vector<double>& span, uint64_t word) const {
    Axis axis;
    axis.uniform = span;
    return axis.draw(types::hashed(sweep_.seed, pose_, word));
}

void Placement::add(size_t number, const std::vector<std::string>& names) {
    const ObjectGroup& group = sweep_.objects[number];
    const uint64_t first_word = stream + (uint64_t{number} << 48);
    size_t wanted = names.size();
    if (!group.count.empty()) {
        const double drawn = between({double(group.count[0]), double(group.count[1]) + 1}, first_word - 1);
        wanted = std::min<size_t>({wanted, static_cast<size_t>(drawn), group.count[1]});
    }
    const std::vector<bool> present = chosen(names.size(), wanted, first_word - 2);
    size_t placed_count = 0;
    for (size_t i = 0; i < names.size(); ++i) {
        const Placeable& object = scene_.placeables.at(names[i]);
        if (!present[i]) {
            objects_.push_back({names[i], object.filed, false});
            objects_.back().at.position.z -= out_of_range;
            continue;
        }
        std::optional<PlacedObject> placed;
        groundless_ = 0;
        for (uint64_t attempt = 0; attempt < tries && !placed; ++attempt)
            placed = tryOnce(group, names[i], first_word + (i * tries + attempt) * words_per_try);
        if (!placed)
            throw types::ConfigError(
                {{fmt::format("objects[{}]", number),
                  fmt::format("has room for {} of its {} objects at pose {}, of {} tries each; {}", placed_count,
                              wanted, pose_, tries,
                              groundless_ == tries
                                  ? "no ground, " + *group.ground + ", is below its area: give it another area"
                                  : "give it a larger area, fewer objects or a smaller gap"),
                  sweep_.file, group.line, group.column}});
        objects_.push_back(std::move(*placed));
        ++placed_count;
    }
}

std::vector<bool> Placement::chosen(size_t count, size_t wanted, uint64_t last_word) const {
    std::vector<size_t> order(count);
    std::iota(order.begin(), order.end(), size_t{0});
    std::vector<bool> is_chosen(count, false);
    for (size_t i = 0; i < wanted; ++i) {
        std::swap(order[i], order[i + types::hashed(sweep_.seed, pose_, last_word - i) % (count - i)]);
        is_chosen[order[i]] = true;
    }
    return is_chosen;
}

std::optional<PlacedObject> Placement::tryOnce(const ObjectGroup& group, const std::string& name, uint64_t word) {
    const Placeable& filed = scene_.placeables.at(name);
    glm::dvec2 at{between(group.x, word), between(group.y, word + 1)};
    if (group.frame == Frame::Vehicle) {
        const double heading = computeHeading(vehicle_), c = std::cos(heading), s = std::sin(heading);
        at = {vehicle_.position.x + c * at.x - s * at.y, vehicle_.position.y + s * at.x + c * at.y};
    }
    const glm::dquat turn = computeTurn(group, word);
    Placeable object = group.tilts() ? turned(filed, turn) : filed;
    const double scale = group.scale.empty() ? 1 : between(group.scale, word + scale_words);
    object.radius *= scale, object.low *= scale;
    const Circle circle{at.x, at.y, object.radius};
    if (!isFree(group, circle)) return std::nullopt;
    const std::optional<double> z = height(group, object, circle, word + 2);
    groundless_ += !z;
    if (!z) return std::nullopt;
    PlacedObject placed{name, object.filed, true, scale};
    placed.at.position = {at.x, at.y, *z};
    placed.at.orientation = turn * placed.at.orientation;
    taken_.push_back(circle);
    return placed;
}

glm::dquat Placement::computeTurn(const ObjectGroup& group, uint64_t word) const {
    if (group.any_turn) {  // K. Shoemake, Uniform random rotations, in Graphics Gems III, 1992
        const double share = between({0, 1}, word + tilt_words), near = std::sqrt(1 - share), far = std::sqrt(share);
        const double a = types::radians(between({0, 360}, word + tilt_words + 1)),
                     b = types::radians(between({0, 360}, word + 3));
        return {far * std::cos(b), near * std::sin(a), near * std::cos(a), far * std::sin(b)};
    }
    const auto angle = [&](const std::vector<double>& span, uint64_t of) {
        return span.empty() ? 0 : between(span, of);
    };
    return types::Mount{{},
                        angle(group.roll_deg, word + tilt_words),
                        angle(group.pitch_deg, word + tilt_words + 1),
                        angle(group.yaw_deg, word + 3)}
        .orientation();
}

bool Placement::isFree(const ObjectGroup& group, const Circle& circle) const {
    for (const Circle& other : taken_)
        if (std::hypot(circle.x - other.x, circle.y - other.y) < circle.radius + other.radius + group.gap) return false;
    for (const auto& [name, box] : scene_.boxes)
        if (std::ranges::any_of(group.avoid, [&](const std::string& pattern) { return matches(pattern, name); }) &&
            distanceTo(box, circle.x, circle.y) < circle.radius + group.gap)
            return false;
    return true;
}

std::optional<double> Placement::height(const ObjectGroup& group, const Placeable& object, const Circle& at,
                                        uint64_t word) const {
    if (!group.z.empty()) return between(group.z, word);
    if (!group.ground) return object.filed.position.z;
    const std::optional<double> ground = highestAt(scene_.grounds.at(*group.ground), at.x, at.y);
    if (!ground) return std::nullopt;
    return std::round((*ground - object.low) * 1e6) / 1e6;
}

}  // namespace insonify::dataset
