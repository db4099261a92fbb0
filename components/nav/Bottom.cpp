#include "components/nav/Bottom.hpp"

#include <utility>

#include "types/MeshRays.hpp"
#include "types/PosedMesh.hpp"

namespace insonify::nav {

const types::Mesh& Bottom::meshOf(size_t object) const {
    const types::Geometry& geometry = *snapshot_->geometry;
    return geometry.meshes[static_cast<size_t>(geometry.objects[object].mesh)];
}

const types::Mesh& Bottom::posed(const types::DeformedObject& deformed) {
    const auto found = posed_.try_emplace(deformed.object, meshOf(deformed.object)).first;
    types::poseMesh(types::poseOf(*snapshot_, deformed, *found->second.deformation), found->second);
    return found->second;
}

void Bottom::place(size_t object, const glm::dmat4& world_from_object, const types::Mesh& mesh) {
    Placed placed;
    placed.world_from_object = world_from_object;
    placed.mesh = &mesh;
    for (const types::Cluster& cluster : mesh.clusters) {
        const types::WorldBox box(world_from_object, cluster.centre, cluster.half);
        placed.low = glm::min(placed.low, box.centre - box.half);
        placed.high = glm::max(placed.high, box.centre + box.half);
    }
    placed_[object] = placed;
}

void Bottom::take(types::SnapshotPtr snapshot) {
    const bool is_other = !snapshot_ || snapshot_->geometry != snapshot->geometry;
    snapshot_ = std::move(snapshot);
    if (!snapshot_->geometry) return placed_.clear();
    const std::vector<types::Object>& objects = snapshot_->geometry->objects;
    if (is_other) {
        placed_.assign(objects.size(), {});
        for (size_t i = 0; i < objects.size(); ++i) place(i, objects[i].world_from_object, meshOf(i));
        changed_.clear();
        posed_.clear();
    }
    for (const size_t object : changed_) place(object, objects[object].world_from_object, meshOf(object));
    changed_.clear();
    for (const types::MovedObject& moved : snapshot_->moved) {
        place(moved.object, moved.world_from_object, meshOf(moved.object));
        changed_.push_back(moved.object);
    }
    for (const types::DeformedObject& deformed : snapshot_->deformed) {
        place(deformed.object, glm::dmat4(placed_[deformed.object].world_from_object), posed(deformed));
        changed_.push_back(deformed.object);
    }
}

bool Bottom::isUnderWater(const glm::dvec3& place) const {
    return !snapshot_ || !snapshot_->water_surface || place.z < *snapshot_->water_surface;
}

std::optional<double> Bottom::range(const glm::dvec3& from, const glm::dvec3& direction, double farthest) const {
    if (snapshot_) return rangeOfScene(from, direction, farthest);
    if (!height_ || direction.z == 0) return {};
    const double range = (*height_ - from.z) / direction.z;
    return range > 0 && range <= farthest ? std::optional(range) : std::nullopt;
}

std::optional<double> Bottom::rangeOfScene(const glm::dvec3& from, const glm::dvec3& direction, double farthest) const {
    double nearest = farthest;
    bool is_met = false;
    for (size_t i = 0; i < placed_.size(); ++i) {
        const Placed& placed = placed_[i];
        const glm::dvec3 way = direction * nearest;
        if (placed.mesh->clusters.empty() ||
            !types::meetsBox(from, way, (placed.low + placed.high) / 2.0, (placed.high - placed.low) / 2.0))
            continue;
        double share = 1;
        types::anyTriangleMet(*placed.mesh, placed.world_from_object, from, way, [&](double met, bool, size_t) {
            share = std::min(share, met);
            return false;
        });
        is_met = is_met || share < 1;
        nearest *= share;
    }
    return is_met ? std::optional(nearest) : std::nullopt;
}

}  // namespace insonify::nav
