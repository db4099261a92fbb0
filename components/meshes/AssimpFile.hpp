#pragma once
#include <filesystem>
#include <glm/mat4x4.hpp>

#include "components/meshes/FileMeshes.hpp"

namespace insonify::meshes {

/** Reads a mesh file with assimp. Damaged files may crash or hang assimp or exhaust memory, so use this only in a
 *  separate process.
 *
 *  `world_from_file` turns the file's axes; assimp applies the unit and up axis of .dae, and gives y-up. Throws
 *  std::runtime_error with a sentence about the file if it is refused, std::bad_alloc if memory is exhausted. */
FileMeshes readByAssimp(const std::filesystem::path& file, const glm::dmat4& world_from_file);

}  // namespace insonify::meshes
