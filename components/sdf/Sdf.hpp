#pragma once
#include "components/scene/Scene.hpp"

namespace insonify::sdf {

/** `readScene` for SDF 1.2 to 1.9, by libsdformat: the first world of a file, or its model.
 *
 *  Each model and link is a node, named by its scope ("rov::arm::hand"). A link, or a nested model, that a joint hangs
 *  on another link is below that link's node; all others are below their model's. Objects are the visuals. What is not
 *  found (an include, a mesh, a picture) and what libsdformat warns of is in Geometry::notices. Where files are looked
 *  for: meshes::ModelPaths. */
scene::Scene readSdf(const std::filesystem::path& file);

}  // namespace insonify::sdf
