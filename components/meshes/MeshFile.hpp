#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "components/meshes/FileMeshes.hpp"
#include "components/scene/Scene.hpp"
#include "types/geometry/Geometry.hpp"

namespace insonify::meshes {

/** The program that reads .dae, .obj, .stl and .ply: damaged files may crash or hang its library or exhaust memory. */
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

/** Reads a mesh that a scene refers to: .dae, .obj, .stl, .ply, .gltf or .glb.
 *
 *  Objects are placed as in the file, in metres: the unit of .dae is applied; .gltf and .glb are in metres; .obj, .stl
 *  and .ply specify neither unit nor up axis and are taken as they are. Geometry::notices lists what was omitted.
 * Throws types::ConfigError for a file of another kind, a damaged file, or a file without triangles. */
types::GeometryPtr readMeshFile(const std::filesystem::path& file, MeshAxes axes);

/** Reads a mesh file, .dae, .obj, .stl or .ply, as a scene: a node with the name of the file, below it those of the
 *  file. A material without a name has that of the file. Throws as readMeshFile(). */
scene::Scene readMeshScene(const std::filesystem::path& file);

}  // namespace insonify::meshes
