#pragma once
#include <cstdint>
#include <filesystem>

#include "components/meshes/FileMeshes.hpp"
#include "types/Geometry.hpp"

namespace insonify::meshes {

/** The program that reads .dae, .obj and .stl: damaged files may crash or hang its library or exhaust memory. */
inline constexpr const char* mesh_reader = "insonify-read-mesh";

/** Resource limits for reading one file. */
struct ReadLimits {
    unsigned processor_s = 10;            ///< Computing time [s].
    unsigned wall_s = 120;                ///< Time from start to end, longer because the machine may be busy [s].
    uint64_t memory = uint64_t{1} << 30;  ///< Address space, including the libraries' [bytes].

    /** Returns the limits for a file of this size: for each megabyte 2 s of computing, 20 s of wall time and 128 MB
     *  more. */
    static ReadLimits forFile(uintmax_t bytes);
};

/** Reads a mesh file in a separate process, within limits.
 *
 *  The process is the program insonify-read-mesh in the folder of the component libraries; the environment variable
 *  INSONIFY_MESH_READER names another. However that process ends, this process continues: a types::ConfigError names
 *  the file, the failure and the remedy. Safe to call from any thread. */
FileMeshes readMeshesApart(const std::filesystem::path& file, MeshAxes axes, const ReadLimits& limits);

/** Reads a mesh that a scene refers to: .dae, .obj, .stl, .gltf or .glb.
 *
 *  Objects are placed as in the file, in metres: the unit of .dae is applied; .gltf and .glb are in metres; .obj and
 *  .stl specify neither unit nor up axis and are taken as they are. Geometry::notices lists what was omitted. Throws
 *  types::ConfigError for a file of another kind, a damaged file, or a file without triangles. */
types::GeometryPtr readMeshFile(const std::filesystem::path& file, MeshAxes axes);

}  // namespace insonify::meshes
