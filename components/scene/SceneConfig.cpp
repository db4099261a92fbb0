#include "components/scene/SceneConfig.hpp"

#include "types/Angle.hpp"

namespace insonify::scene {

glm::dquat Mount::orientation() const {
    const auto about = [](glm::dvec3 axis, double deg) { return glm::angleAxis(types::radians(deg), axis); };
    return about({0, 0, 1}, yaw_deg) * about({0, 1, 0}, pitch_deg) * about({1, 0, 0}, roll_deg);
}

void place(const types::Pose& body, const Mount& mount, types::Pose& sensor) {
    const glm::dquat world_from_body = glm::normalize(body.orientation);
    sensor.time = body.time;
    sensor.source_frame = "sonar";
    sensor.target_frame = body.target_frame;
    sensor.position = body.position + world_from_body * mount.position;
    sensor.orientation = world_from_body * mount.orientation();
}

}  // namespace insonify::scene
