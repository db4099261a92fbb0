#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "types/geometry/Snapshot.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::viewer {

/** Vertices and triangles of a mesh as sent. */
struct Part {
    std::vector<float> positions;  ///< Three for each vertex [m].
    std::vector<uint32_t> indices;
    int material = 0;
};

/** Returns a mesh as sent: the vertices that its triangles use, in the order of their first use. */
Part getPart(const types::Mesh& mesh, bool coarse);

/** The part of a scene that is shown. In a scene of more than `max_triangles`, large meshes are reduced to outlines;
 *  then the objects with the fewest triangles are omitted. */
struct ShownScene {
    std::vector<Part> parts;      ///< By mesh; empty if no shown object uses it.
    std::vector<size_t> objects;  ///< Numbers, ascending.
    bool coarse = false;
};
ShownScene shownScene(const types::Geometry& geometry, size_t max_triangles);

/** Returns a scene as a message for pages (see pageMessage): JSON of meshes, objects and materials, then the positions
 *  (three floats a vertex) and indices (u32) of all meshes, as in glTF buffers. The JSON has the number of omitted
 *  objects. */
std::string sceneMessage(const types::Geometry& geometry, size_t max_triangles, const std::string& source);

/** Returns the poses of the sonar and of moving objects for pages: JSON. Where objects deform, it is a message of
 *  snapshot_kind, with the positions of their vertices in the order of sceneMessage(). */
std::string snapshotMessage(const types::Snapshot& snapshot, size_t max_triangles, const std::string& source);

/** Returns a pose as JSON. */
std::string poseText(const types::Pose& pose, const std::string& source);

}  // namespace insonify::viewer
