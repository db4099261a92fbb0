#include "components/sonar/rays/TreesAhead.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace insonify::sonar {
namespace {

constexpr double origin_spacing = 512;  // [m]

/** Returns the distance from a place to the cell of places whose origin is `origin` [m]. */
double distanceToCell(const glm::dvec3& place, const glm::dvec3& origin) {
    return glm::length(glm::max(glm::abs(place - origin) - origin_spacing / 2, 0.0));
}

}  // namespace

glm::dvec3 originNear(const glm::dvec3& sonar) { return origin_spacing * glm::round(sonar / origin_spacing); }

std::vector<TreeObject> objectsAbout(const std::vector<TreeObject>& in_world, const glm::dvec3& origin) {
    std::vector<TreeObject> objects = in_world;
    for (TreeObject& object : objects) object.place[3] -= glm::dvec4(origin, 0);
    return objects;
}

bool TreesAhead::follow(const glm::dvec3& sonar, const Objects& objects) {
    const double way = before_ ? glm::distance(*before_, sonar) : 0;
    before_ = sonar;
    const int64_t version = version_;
    if (objects != objects_) takeObjects(objects);
    if (way == 0 && version == version_) return false;
    const Origins origins = way > 0 && way <= near ? originsAround(sonar) : Origins();
    if (origins.count == 0 && origins_.count == 0) return false;
    if (version == version_ && std::ranges::is_permutation(origins.needed(), origins_.needed())) return false;
    origins_ = origins;
    return true;
}

void TreesAhead::takeObjects(const Objects& objects) {
    if (!objects_ || *objects != *objects_) ++version_;
    objects_ = objects;
    size_t triangles = 0;
    for (const TreeObject& object : *objects) triangles += object.mesh->indices.size() / 3;
    max_count_ = std::clamp<size_t>(max_triangles / std::max<size_t>(triangles, 1), 2, max_origins);
}

TreesAhead::Origins TreesAhead::originsAround(const glm::dvec3& sonar) const {
    const glm::dvec3 own = originNear(sonar);
    Origins origins;
    for (int corner = 0; corner < 8; ++corner) {
        glm::dvec3 origin = own;
        for (int axis = 0; axis < 3; ++axis)
            if (corner >> axis & 1) origin[axis] += sonar[axis] < own[axis] ? -origin_spacing : origin_spacing;
        const double distance = distanceToCell(sonar, origin);
        if (distance > (needs(origin) ? kept : near)) continue;
        size_t at = origins.count++;
        for (; at > 0 && distanceToCell(sonar, origins.all[at - 1]) > distance; --at)
            origins.all[at] = origins.all[at - 1];
        origins.all[at] = origin;
    }
    origins.count = origins.count == 1 ? 0 : std::min(origins.count, max_count_);
    return origins;
}

bool TreesAhead::needs(const glm::dvec3& origin) const { return std::ranges::count(origins_.needed(), origin) > 0; }

void TreesAhead::send() {
    MadeAhead::Items items;
    for (const glm::dvec3& origin : origins_.needed()) {
        items.push_back({{version_, std::bit_cast<int64_t>(origin.x), std::bit_cast<int64_t>(origin.y),
                          std::bit_cast<int64_t>(origin.z)},
                         [objects = objects_, origin](const std::atomic<bool>& quits) {
                             const auto tree = StillTree::of(objectsAbout(*objects, origin));
                             tree->tree(&quits);
                             return tree;
                         }});
    }
    ahead_.take(std::move(items));
}

}  // namespace insonify::sonar
