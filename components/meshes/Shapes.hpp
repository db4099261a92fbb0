#pragma once
#include <filesystem>

#include "components/scene/Surface.hpp"

namespace insonify::meshes {

// Shapes of SDF about their origins, faces outward. Round shapes have 64 facets around. Their vertices are on the true
// surface, from which the facets deviate by at most 0.12 % of the radius.

scene::Surface unitBox();       ///< Side 1 [m].
scene::Surface unitPlane();     ///< A square of side 1 in z = 0 that faces up [m].
scene::Surface unitSphere();    ///< Radius 1 [m].
scene::Surface unitCylinder();  ///< Radius 1 and height 1 along z [m].
scene::Surface unitCone();      ///< Radius 1 at its base, height 1 along z, its point up [m].
/** A cylinder of `length` along z between half spheres of `radius` [m]. */
scene::Surface capsule(double radius, double length);

/** Makes terrain from a grey picture, 8 or 16 bits, PNG, JPEG or binary PGM. White is `size.z` above black, columns run
 *  along x, the top row is at +y, and the centre of its black plane is at the origin. Each pixel is a vertex; a picture
 *  with a side of more than 2049 pixels is subsampled. Throws std::runtime_error for a picture that cannot be read. */
scene::Surface readHeightmap(const std::filesystem::path& file, glm::dvec3 size);

}  // namespace insonify::meshes
