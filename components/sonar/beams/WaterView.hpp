#pragma once
#include <glm/vec3.hpp>

#include "components/sonar/beams/BeamFan.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::sonar {

/** Orientation and height of the sonar of one ping in the water. */
struct WaterView {
    glm::dvec3 up{0, 0, 1};  ///< The world's z in sonar axes, unit [1].
    double height = 0;       ///< Height of the sonar above the water surface, or above the world's z = 0 [m].
};
WaterView waterView(const types::Snapshot& snapshot);

/** Returns the world's up in the axes of a frustum. */
glm::dvec3 upwardIn(const ViewFrustum& frustum, const WaterView& water);

}  // namespace insonify::sonar
