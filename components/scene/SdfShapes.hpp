#pragma once
#include "components/scene/Surface.hpp"

namespace insonify::scene {

// Shapes of SDF about their origins, faces outward. Round ones have 64 facets around, their corners on the true
// surface, from which they are off by 0.12 % of the radius at most.

Surface unitBox();       ///< Of side 1 [m].
Surface unitPlane();     ///< A square of side 1 in z = 0 that faces up [m].
Surface unitSphere();    ///< Of radius 1 [m].
Surface unitCylinder();  ///< Of radius 1 and height 1 along z [m].
/** A cylinder of `length` along z between half spheres of `radius` [m]. */
Surface capsule(double radius, double length);

}  // namespace insonify::scene
