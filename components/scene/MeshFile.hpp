#pragma once
#include <filesystem>

#include "types/Geometry.hpp"

namespace insonify::scene {

/** Reads a mesh that a scene refers to: .dae, .obj, .stl, .gltf or .glb.
 *
 *  Objects stand as the file arranges them, in metres and z-up: the unit and up axis of .dae are honoured, .gltf and
 *  .glb are y-up, .obj and .stl tell neither and are taken as they are. What was left out is in Geometry::notices.
 *  Throws types::ConfigError for a file of another kind, damaged or without triangles. */
types::GeometryPtr readMeshFile(const std::filesystem::path& file);

}  // namespace insonify::scene
