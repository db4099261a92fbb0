#pragma once
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <span>
#include <string>
#include <vector>

#include "components/scene/Surface.hpp"

namespace insonify::meshes {

/** The axes in which a mesh is placed. */
enum class MeshAxes {
    AsStored,  ///< Those of the file's numbers, whatever it declares as up: Gazebo and RViz read meshes this way.
    ZUp        ///< The file's up axis turned to z: that of .dae as it declares it, y of .gltf and .glb.
};

/** The triangles of a mesh file as stored, before any is dropped or grouped into clusters. */
struct FileMeshes {
    struct Part {
        std::string name;
        uint32_t material = 0;   ///< Index into `materials`.
        scene::Surface surface;  ///< Positions [m] and indices only; empty if the part has no triangles.
    };
    struct Placing {
        std::string name;  ///< Name of the node.
        uint32_t part = 0;
        glm::dmat4 world_from_part{1};
    };
    std::vector<std::string> materials;  ///< Names of the materials.
    std::vector<Part> parts;
    std::vector<Placing> placings;
};

/** The reply of the program that reads mesh files: meshes, or a sentence with the reason why there are none. */
struct MeshReply {
    std::string refusal;  ///< Empty if the meshes were read.
    FileMeshes meshes;
};

/** File descriptor to which that program writes its reply. */
inline constexpr int mesh_reply_descriptor = 3;

/** Writes a reply as bytes in this machine's order, without copying the large arrays. Returns false if not all bytes
 *  could be written. */
bool writeReply(const MeshReply& reply, std::FILE* file);

/** Parses the bytes of one reply without trusting them: throws std::runtime_error if they end too early or too late, or
 *  if an index is out of range. */
MeshReply parseReply(std::span<const std::byte> bytes);

}  // namespace insonify::meshes
