#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace insonify::types {

/** Returns for each vertex the first vertex at the same place. Programs write the two sides of a seam, or the vertices
 *  around a pole, with different rounding. So vertices that differ by at most 2^-22 of the mesh's extent, its longest
 *  side, are at the same place, as are those within 2^-22 of its largest coordinate, the precision of floats there, if
 *  that is below a sixteenth of the median edge. Edges are pairs of neighbours in triangles of `indices`. A place
 *  reaches this far from its first vertex, so chains of close vertices do not collapse.
 *  @param positions  finite [m] */
std::vector<uint32_t> weldedPlaces(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices);

}  // namespace insonify::types
