#pragma once
#include <memory>
#include <vector>

#include "types/Geometry.hpp"

namespace insonify::study {

/** A parallelogram: a corner and two edges [m]. */
types::Mesh quad(glm::vec3 corner, glm::vec3 a, glm::vec3 b);
/** A disc that faces -x, about (distance, 0, 0), of `segments` triangles [m]. */
types::Mesh disc(double distance, double radius, int segments);
/** A sphere about the origin, of `rings` times 2 `rings` quads, their corners on it [m]. */
types::Mesh sphere(double radius, int rings);

/** One object for each mesh, at `positions` or else the origin, of one material with 10^(lambert_db/10) = 1. */
types::GeometryPtr sceneOf(std::vector<types::Mesh> meshes, std::vector<glm::dvec3> positions = {});

}  // namespace insonify::study
