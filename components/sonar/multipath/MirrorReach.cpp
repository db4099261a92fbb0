#include "components/sonar/multipath/MirrorReach.hpp"

#include <algorithm>
#include <utility>

namespace insonify::sonar {
namespace {

constexpr size_t room_per_mirror = 64;  ///< Mirrors that may follow; if there are more, they are searched again.

}  // namespace

MirrorReach::Beam::Beam(const PlacedMirror& mirror, double longest_way, double rounding)
    : apex(mirror.sonar_image),
      front(mirror.sonar_side > 0 ? mirror.plane : MirrorPlane{-mirror.plane.normal, -mirror.plane.distance}),
      longest(longest_way),
      doubt(rounding) {
    if (!mirror.flat) return;
    const std::array<glm::dvec3, 4>& outline = mirror.flat->outline;
    const glm::dvec3 middle = (outline[0] + outline[1] + outline[2] + outline[3]) / 4.0 - apex;
    for (size_t k = 0; k < 4; ++k) {
        const glm::dvec3 from = outline[k] - apex, to = outline[(k + 1) % 4] - apex;
        product[k] = glm::length(from) * glm::length(to);
        sum[k] = glm::length(from) + glm::length(to);
        const glm::dvec3 side = glm::cross(from, to);
        const double inside = glm::dot(side, middle);
        if (std::abs(inside) > doubt * (product[k] + glm::length(middle) * sum[k]))
            inward[k] = inside > 0 ? side : -side;
    }
}

bool MirrorReach::Beam::mayMeet(const Box& box) const {
    const glm::dvec3 centre = box.centre() - apex, half = box.half();
    if (glm::length(glm::max(glm::abs(centre) - half, 0.0)) > longest + doubt) return false;
    const double ahead = glm::dot(front.normal, box.centre()) - front.distance;
    if (ahead + glm::dot(glm::abs(front.normal), half) < -doubt) return false;
    const double reach = glm::length(centre) + glm::length(half);
    for (size_t k = 0; k < 4; ++k)
        if (glm::dot(inward[k], centre) + glm::dot(glm::abs(inward[k]), half) < -doubt * (product[k] + reach * sum[k]))
            return false;
    return true;
}

bool MirrorReach::Beam::mayMeet(const std::array<glm::dvec3, 4>& outline) const {
    const auto allBehind = [&](const auto& isBehind) { return std::ranges::all_of(outline, isBehind); };
    if (allBehind([&](const glm::dvec3& point) { return glm::dot(front.normal, point) - front.distance < -doubt; }))
        return false;
    for (size_t k = 0; k < 4; ++k)
        if (allBehind([&](const glm::dvec3& point) {
                const glm::dvec3 off = point - apex;
                return glm::dot(inward[k], off) < -doubt * (product[k] + glm::length(off) * sum[k]);
            }))
            return false;
    return true;
}

MirrorReach::MirrorReach(size_t count) : boxes_(count - std::min<size_t>(count, 1)), found_(count) {
    seconds_.reserve(count * std::min(count, room_per_mirror));
}

void MirrorReach::place(std::span<const PlacedMirror> mirrors, double longest, double doubt) {
    mirrors_ = mirrors;
    longest_ = longest;
    doubt_ = doubt;
    for (size_t i = 0; i < boxes_.size(); ++i) boxes_[i] = mirrors[i + 1].box;
    if (std::exchange(has_tree_, true))
        tree_.refit(boxes_);
    else
        tree_ = BoxTree(boxes_);
    seconds_.clear();
    for (size_t first = 0; first < mirrors.size(); ++first) {
        Found& found = found_[first];
        found = {static_cast<uint32_t>(seconds_.size()), 0, true};
        forEachMet(first, [&](size_t second) {
            found.is_complete &= seconds_.size() < seconds_.capacity();
            if (found.is_complete) seconds_.push_back(static_cast<uint32_t>(second));
        });
        if (!found.is_complete) seconds_.resize(found.begin);
        found.count = static_cast<uint32_t>(seconds_.size()) - found.begin;
    }
}

}  // namespace insonify::sonar
