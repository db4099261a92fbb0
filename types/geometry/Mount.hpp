#pragma once
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "types/geometry/Angle.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::types {

/** The pose of a sensor in the body: x forward, y left, z up; R = Rz(yaw) Ry(pitch) Rx(roll). */
struct Mount {
    glm::dvec3 position{0};                           ///< [m]
    double roll_deg = 0, pitch_deg = 0, yaw_deg = 0;  ///< Positive pitch looks down, positive yaw turns to port [deg].

    glm::dquat orientation() const {
        const auto about = [](glm::dvec3 axis, double deg) { return glm::angleAxis(radians(deg), axis); };
        return about({0, 0, 1}, yaw_deg) * about({0, 1, 0}, pitch_deg) * about({1, 0, 0}, roll_deg);
    }

    static void describe(auto& self, auto& visit) {
        visit({"position", "m", "of the sensor in the body"}, self.position);
        visit({"roll_deg", "deg", "about x", -360, 360}, self.roll_deg);
        visit({"pitch_deg", "deg", "about y, positive looks down", -360, 360}, self.pitch_deg);
        visit({"yaw_deg", "deg", "about z, positive turns to port", -360, 360}, self.yaw_deg);
    }
};

/** Sets the pose of the sensor in the world, at the body's time; velocities stay unknown. */
inline void place(const Pose& body, const Mount& mount, Pose& sensor) {
    const glm::dquat world_from_body = glm::normalize(body.orientation);
    sensor.time = body.time;
    sensor.source_frame = "sonar";
    sensor.target_frame = body.target_frame;
    sensor.position = body.position + world_from_body * mount.position;
    sensor.orientation = world_from_body * mount.orientation();
}

}  // namespace insonify::types
