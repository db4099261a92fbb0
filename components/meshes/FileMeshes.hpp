#pragma once
#include <cstddef>
#include <cstdio>
#include <glm/mat4x4.hpp>
#include <span>
#include <string>
#include <vector>

#include "components/scene/Surface.hpp"

namespace insonify::meshes {

/** The triangles of a mesh file as they stand there, before anything is dropped or divided into clusters. */
struct FileMeshes {
    struct Part {
        std::string name;
        uint32_t material = 0;   ///< Index into `materials`.
        scene::Surface surface;  ///< Positions [m] and indices only; none where the part has no triangles.
    };
    struct Placing {
        std::string name;  ///< Of the node.
        uint32_t part = 0;
        glm::dmat4 world_from_part{1};
    };
    std::vector<std::string> materials;  ///< By name.
    std::vector<Part> parts;
    std::vector<Placing> placings;
};

/** What the program that reads mesh files answers: meshes, or a sentence that says why there are none. */
struct MeshReply {
    std::string refusal;  ///< Empty where the meshes are there.
    FileMeshes meshes;
};

/** File descriptor to which that program writes its reply. */
inline constexpr int mesh_reply_descriptor = 3;

/** Writes a reply as bytes of this machine's order, the large arrays without another copy; false where not all of them
 *  could be written. */
bool writeReply(const MeshReply& reply, std::FILE* file);

/** Reads the bytes of one reply, and trusts none of them: throws std::runtime_error where they end early or late, or an
 *  index leads nowhere. */
MeshReply parseReply(std::span<const std::byte> bytes);

}  // namespace insonify::meshes
