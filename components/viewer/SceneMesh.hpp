#pragma once
#include <string>

#include "types/Pose.hpp"
#include "types/Snapshot.hpp"

namespace insonify::viewer {

/** A scene as a message for pages (see pageMessage): JSON of meshes, objects and materials; then the positions (three
 *  floats a vertex) and indices (u32) of all meshes, as glTF's buffers have them. In a scene of more than
 *  `max_triangles` large meshes are their outlines, and then the objects of the fewest triangles are
 *  left out, which the JSON counts; meshes of none that is left are empty. */
std::string sceneMessage(const types::Geometry& geometry, size_t max_triangles, const std::string& source);

/** Where the sonar and what moves are, in JSON. */
std::string snapshotText(const types::Snapshot& snapshot, const std::string& source);

/** A pose in JSON. */
std::string poseText(const types::Pose& pose, const std::string& source);

}  // namespace insonify::viewer
