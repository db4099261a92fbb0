#pragma once
#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>
#include <numeric>
#include <span>
#include <vector>

#include "types/geometry/Geometry.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::types {

/** Returns for each vertex the first vertex at the same place. Programs write the two sides of a seam, or the vertices
 *  around a pole, with different rounding. So vertices that differ by at most 2^-22 of the mesh's extent, its longest
 *  side, are at the same place, as are those within 2^-22 of its largest coordinate, the precision of floats there, if
 *  that is below a sixteenth of the median edge. Edges are pairs of neighbours in triangles of `indices`. A place
 *  reaches this far from its first vertex, so chains of close vertices do not collapse.
 *  @param positions  finite [m] */
std::vector<uint32_t> weldedPlaces(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices);

/** Sorts items first by a vertex of a mesh, then by themselves, and calls act(items) for those of each vertex. Takes
 *  linear time where few items have one vertex. `forEach(add)` calls add(vertex, item) for each item; it is called
 * twice. */
template <class Item, class ForEach, class Act>
std::vector<Item> sortByVertex(size_t vertices, const ForEach& forEach, const Act& act) {
    std::vector<uint32_t> end(vertices);  // of the items of a vertex, once all are placed
    forEach([&](uint32_t vertex, const Item&) { ++end[vertex]; });
    std::vector<Item> items(std::accumulate(end.begin(), end.end(), size_t{0}));
    std::exclusive_scan(end.begin(), end.end(), end.begin(), 0u);
    forEach([&](uint32_t vertex, const Item& item) { items[end[vertex]++] = item; });
    for (size_t vertex = 0, begin = 0; vertex < vertices; begin = end[vertex++]) {
        const std::span own = std::span(items).subspan(begin, end[vertex] - begin);
        std::ranges::sort(own);
        act(own);
    }
    return items;
}

/** The pose of one mesh: a pose per joint of its skin, a weight per morph target. */
struct MeshPose {
    std::span<const JointPose> joints;
    std::span<const MorphPose> morphs;
};

/** Returns the pose of an object, which is part of the snapshot. */
MeshPose getPose(const Snapshot& snapshot, const DeformedObject& deformed, const Deformation& deformation);

/** Returns whether all objects that the snapshot deforms can deform, and have the joints and targets they need. */
bool deformsRightly(const Snapshot& snapshot);

/** Moves positions, normals, tangents and the boxes of clusters of a mesh that has a Deformation: first morph targets,
 *  then joints, by glTF 2.0 (3.7.3, 3.7.2.2). Sums are in double precision. Positions that are not finite become the
 *  origin. Allocates nothing. */
void poseMesh(const MeshPose& pose, Mesh& mesh);

/** Fills in the velocity of each vertex, in the axes of the mesh [m/s]. */
void computeVelocities(const MeshPose& pose, const Deformation& deformation, std::vector<glm::vec3>& velocities);

/** Returns the geometry of a snapshot with deformed objects in their shape, each with its own mesh after those of
 *  the geometry. Returns the same geometry if no object is deformed. */
GeometryPtr posedGeometry(const Snapshot& snapshot);

/** Sets the boxes of clusters and their nodes to the bounds of their triangles. */
void boundClusters(Mesh& mesh);

}  // namespace insonify::types
