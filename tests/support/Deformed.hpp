#pragma once
// Meshes that deform, and the same shapes in meshes that cannot.
#include <memory>
#include <utility>

#include "types/geometry/PosedMesh.hpp"

namespace insonify::test {

/** Returns the mesh with one joint, which all of it follows. */
inline types::Mesh jointed(types::Mesh mesh) {
    auto deformation = std::make_shared<types::Deformation>();
    deformation->positions = mesh.positions;
    deformation->normals = mesh.normals;
    deformation->tangents = mesh.tangents;
    deformation->joint_count = 1;
    for (uint32_t i = 0; i <= mesh.positions.size(); ++i) deformation->share_begin.push_back(i);
    deformation->shares.assign(mesh.positions.size(), {0, 1});
    mesh.deformation = std::move(deformation);
    return mesh;
}

/** Poses one object by its joint. */
inline void pose(types::Snapshot& snapshot, uint32_t object, const glm::dmat4& mesh_from_bind) {
    snapshot.deformed.push_back({object, static_cast<uint32_t>(snapshot.joints.size()), 0});
    snapshot.joints.push_back({glm::dmat4x3(mesh_from_bind)});
}

/** Returns the same shapes, triangle by triangle, in meshes that cannot deform. */
inline types::Snapshot rigid(types::Snapshot snapshot) {
    auto geometry = std::make_shared<types::Geometry>(*types::posedGeometry(snapshot));
    for (types::Mesh& mesh : geometry->meshes) mesh.deformation = nullptr;
    snapshot.geometry = std::move(geometry);
    snapshot.deformed.clear();
    return snapshot;
}

}  // namespace insonify::test
