#pragma once
#include <filesystem>
#include <glm/mat4x4.hpp>

#include "components/meshes/FileMeshes.hpp"

namespace insonify::meshes {

/** Reads a mesh file by assimp, which damaged files may crash, hang or fill memory with: only for a process of its own.
 *
 *  `world_from_file` turns the file's axes; the unit and up axis of .dae are honoured by assimp, which gives y-up.
 *  Throws std::runtime_error with a sentence on the file where it is refused, std::bad_alloc where memory ends. */
FileMeshes readByAssimp(const std::filesystem::path& file, const glm::dmat4& world_from_file);

}  // namespace insonify::meshes
