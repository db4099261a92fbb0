#include "components/sonar/beams/WaterView.hpp"

#include <cmath>

namespace insonify::sonar {

WaterView waterView(const types::Snapshot& snapshot) {
    const glm::dvec3 up = glm::inverse(glm::normalize(snapshot.sonar.orientation)) * glm::dvec3(0, 0, 1);
    return {up, snapshot.sonar.position.z - snapshot.water_surface.value_or(0)};
}

glm::dvec3 upwardIn(const ViewFrustum& frustum, const WaterView& water) {
    const double cosine = std::cos(frustum.azimuth), sine = std::sin(frustum.azimuth);
    return {cosine * water.up.x + sine * water.up.y, cosine * water.up.y - sine * water.up.x, water.up.z};
}

}  // namespace insonify::sonar
