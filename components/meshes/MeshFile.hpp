#pragma once
#include <cstdint>
#include <filesystem>

#include "components/meshes/FileMeshes.hpp"
#include "types/Geometry.hpp"

namespace insonify::meshes {

/** The program that reads .dae, .obj and .stl: damaged files may crash, hang or fill the library that it calls. */
inline constexpr const char* mesh_reader = "insonify-read-mesh";

/** What reading one file may cost. */
struct ReadLimits {
    unsigned processor_s = 10;            ///< Of computing [s].
    unsigned wall_s = 120;                ///< From start to end, more because a machine may be busy [s].
    uint64_t memory = uint64_t{1} << 30;  ///< Address space, the libraries' own in it [bytes].

    /** For a file of so many bytes: for each megabyte 2 s, 20 s by the wall and 128 MB more. */
    static ReadLimits forFile(uintmax_t bytes);
};

/** Reads a mesh file in a process of its own, within limits, and turns it to z-up where it `is_y_up`.
 *
 *  The process is the program insonify-read-mesh, which is looked for where component libraries are; the environment
 *  variable INSONIFY_MESH_READER names another. However it ends, this one goes
 *  on: a types::ConfigError names the file, what happened and what can be done. Safe to call from any thread. */
FileMeshes readMeshesApart(const std::filesystem::path& file, bool is_y_up, const ReadLimits& limits);

/** Reads a mesh that a scene refers to: .dae, .obj, .stl, .gltf or .glb.
 *
 *  Objects stand as the file arranges them, in metres and z-up: the unit and up axis of .dae are honoured, .gltf and
 *  .glb are y-up, .obj and .stl tell neither and are taken as they are. What was left out is in Geometry::notices.
 *  Throws types::ConfigError for a file of another kind, damaged or without triangles. */
types::GeometryPtr readMeshFile(const std::filesystem::path& file);

}  // namespace insonify::meshes
