#pragma once
#include "components/scene/Scene.hpp"

namespace insonify::sdf {

/** Reads a scene from SDF 1.2 to 1.9 with libsdformat: the first world of a file, or its model.
 *
 *  Each model and link is a node, named by its scope ("rov::arm::hand"). A link or nested model that a joint attaches
 *  to another link is below that link's node; every other node is below its model's node. Objects are the visuals.
 *  Geometry::notices lists includes, meshes and pictures that are not found, and the warnings of libsdformat. Files are
 *  searched by meshes::ModelPaths. */
scene::Scene readSdf(const std::filesystem::path& file);

}  // namespace insonify::sdf
