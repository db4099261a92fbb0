#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "types/Pose.hpp"
#include "types/Snapshot.hpp"

namespace insonify::viewer {

/** Vertices and triangles of a mesh as they are sent. */
struct Part {
    std::vector<float> positions;  ///< Three a vertex [m].
    std::vector<uint32_t> indices;
    int material = 0;
};

/** What is shown of a scene. In one of more than `max_triangles` large meshes are their outlines, and then the objects
 * of the fewest triangles are left out. */
struct ShownScene {
    std::vector<Part> parts;      ///< By mesh; empty where no shown object has it.
    std::vector<size_t> objects;  ///< Numbers, ascending.
    bool coarse = false;
};
ShownScene shownScene(const types::Geometry& geometry, size_t max_triangles);

/** A scene as a message for pages (see pageMessage): JSON of meshes, objects and materials; then the positions (three
 *  floats a vertex) and indices (u32) of all meshes, as glTF's buffers have them. The JSON counts what is left out. */
std::string sceneMessage(const types::Geometry& geometry, size_t max_triangles, const std::string& source);

/** Where the sonar and what moves are, in JSON. */
std::string snapshotText(const types::Snapshot& snapshot, const std::string& source);

/** A pose in JSON. */
std::string poseText(const types::Pose& pose, const std::string& source);

}  // namespace insonify::viewer
