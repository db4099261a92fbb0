#pragma once
#include <filesystem>

#include "components/meshes/FileMeshes.hpp"

namespace insonify::meshes {

/** Reads a mesh file with assimp. Damaged files may crash or hang assimp or exhaust memory, so use this only in a
 *  separate process.
 *
 *  Assimp applies the unit of .dae. MeshAxes::ZUp is for .dae alone, whose up axis it applies. Throws
 *  std::runtime_error with a sentence about the file if it is refused, std::bad_alloc if memory is exhausted. */
FileMeshes readByAssimp(const std::filesystem::path& file, MeshAxes axes);

}  // namespace insonify::meshes
