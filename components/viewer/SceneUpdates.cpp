#include "components/viewer/SceneUpdates.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "components/ros/Cdr.hpp"
#include "components/ros/Poses.hpp"
#include "components/ros/Stamps.hpp"
#include "components/viewer/FoxgloveMessages.hpp"
#include "types/geometry/PosedMesh.hpp"
#include "types/geometry/WorldFrame.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::viewer {
namespace {

struct Tint {
    std::string_view material;
    foxglove::Color colour;
};
/** The colours of the page. */
constexpr std::array tints{Tint{"sand", {0.69, 0.60, 0.42, 1}},  Tint{"mud", {0.49, 0.44, 0.35, 1}},
                           Tint{"clay", {0.54, 0.45, 0.38, 1}},  Tint{"gravel", {0.56, 0.53, 0.48, 1}},
                           Tint{"stone", {0.52, 0.51, 0.48, 1}}, Tint{"rock", {0.48, 0.46, 0.43, 1}},
                           Tint{"steel", {0.53, 0.41, 0.31, 1}}, Tint{"concrete", {0.62, 0.63, 0.64, 1}},
                           Tint{"wood", {0.49, 0.36, 0.24, 1}},  Tint{"rubber", {0.20, 0.20, 0.23, 1}}};

foxglove::Color getColour(const types::Geometry& geometry, int material) {
    const auto number = static_cast<size_t>(material);
    const std::string name =
        types::lowered(number < geometry.materials.size() ? geometry.materials[number].name : std::string());
    const auto found = std::ranges::find(tints, name, &Tint::material);
    return found == tints.end() ? foxglove::Color{0.55, 0.58, 0.6, 1} : found->colour;
}

/** Returns the triangles of an object, with points in the axes of a frame. Programs draw points in 32 bits: those of an
 *  object far from the frame's origin are relative to the pose of the triangles. */
foxglove::TriangleListPrimitive getTriangles(const Part& part, const glm::dmat4& world_from_object,
                                             ros::WorldFrame axes) {
    foxglove::TriangleListPrimitive triangles;
    triangles.indices = part.indices;
    const glm::dvec3 place = ros::worldFromRock(axes, glm::dvec3(world_from_object[3]));
    const glm::dvec3 origin = types::isFarOut(place) ? place : glm::dvec3(0);
    triangles.pose.position = {origin.x, origin.y, origin.z};
    for (size_t i = 0; i + 2 < part.positions.size(); i += 3) {
        const glm::dvec4 point(part.positions[i], part.positions[i + 1], part.positions[i + 2], 1);
        const glm::dvec3 world = ros::worldFromRock(axes, glm::dvec3(world_from_object * point));
        triangles.points.push_back({world.x - origin.x, world.y - origin.y, world.z - origin.z});
    }
    return triangles;
}

}  // namespace

Bytes SceneUpdates::whole(const types::Snapshot& snapshot) {
    if (!snapshot.geometry) return nullptr;
    if (isNew(snapshot)) {
        geometry_ = snapshot.geometry;
        shown_ = shownScene(*geometry_, max_triangles_);
        home_.clear();
        for (const size_t i : shown_.objects) home_[i] = geometry_->objects[i].world_from_object;
    }
    moved_.clear();
    addChanged(snapshot, moved_);
    shapes_ = {snapshot.deformed, snapshot.joints, snapshot.morphs};
    Places places = moved_;
    places.insert(home_.begin(), home_.end());
    return makeMessage(snapshot, places, true);
}

void SceneUpdates::addChanged(const types::Snapshot& snapshot, Places& places) const {
    for (const types::MovedObject& one : snapshot.moved)
        if (home_.contains(one.object)) places[one.object] = one.world_from_object;
    for (const types::DeformedObject& one : snapshot.deformed)
        if (const auto home = home_.find(one.object); home != home_.end()) places.insert(*home);
}

Bytes SceneUpdates::moved(const types::Snapshot& snapshot) {
    Places now;
    addChanged(snapshot, now);
    for (const auto& [object, place] : moved_) now.emplace(object, home_.at(object));
    Shapes shapes{snapshot.deformed, snapshot.joints, snapshot.morphs};
    if (now == moved_ && shapes == shapes_) return nullptr;
    moved_ = std::move(now);
    shapes_ = std::move(shapes);
    return makeMessage(snapshot, moved_, false);
}

Bytes SceneUpdates::makeMessage(const types::Snapshot& snapshot, const Places& places, bool all) const {
    foxglove::SceneUpdate update;
    const types::GeometryPtr posed = snapshot.deformed.empty() ? geometry_ : types::posedGeometry(snapshot);
    const ros::Time stamp = ros::toRos(snapshot.time);
    if (all) update.deletions.push_back({stamp, foxglove::SceneEntityDeletion::all, ""});
    for (const auto& [number, place] : places) {
        const types::Object& object = geometry_->objects[number];
        const int mesh = posed->objects[number].mesh;
        const Part own =
            mesh == object.mesh ? Part() : getPart(posed->meshes[static_cast<size_t>(mesh)], shown_.coarse);
        const Part& part = mesh == object.mesh ? shown_.parts[static_cast<size_t>(mesh)] : own;
        foxglove::SceneEntity& entity = update.entities.emplace_back();
        entity.timestamp = stamp;
        entity.frame_id = snapshot.sonar.target_frame;
        entity.id = std::to_string(number) + " " + object.name;
        entity.triangles.push_back(getTriangles(part, place, axes_));
        entity.triangles.back().color = getColour(*geometry_, part.material);
    }
    std::vector<char> bytes;
    ros::encode(update, bytes);
    return toBytes({bytes.begin(), bytes.end()});
}

}  // namespace insonify::viewer
