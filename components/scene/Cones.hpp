#pragma once
#include "types/Geometry.hpp"

namespace insonify::scene {

/** Gives the clusters of a closed mesh the cones from which only their backs are seen: behind its front, which hides
 *  them. Closed: every edge joins two triangles of opposite winding, and every piece encloses a positive volume. */
void findCones(types::Mesh& mesh);

}  // namespace insonify::scene
