#pragma once
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "types/samples/Pose.hpp"

namespace insonify::types {

/** The measurement of an inertial unit, field for field Rock's base::samples::IMUSensors. The axes are those of the
 *  unit: x forward, y left, z up. NaN means unknown. */
struct ImuSensors {
    static constexpr const char* type_name = "/base/samples/IMUSensors";

    Time time;
    glm::dvec3 acc{Pose::unknown};
    glm::dvec3 gyro{Pose::unknown};
    glm::dvec3 mag{Pose::unknown};

    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "when the reading was true in the world"}, self.time);
        visit({"acc", "m/s^2", "specific force: at rest +g upwards"}, self.acc);
        visit({"gyro", "rad/s", "angular rate"}, self.gyro);
        visit({"mag", "T", "magnetic field"}, self.mag);
    }
};

/** Attitude and measurement of an inertial unit in one sample. Rock has two types for it (IMUSensors and
 *  RigidBodyState); the fields are those of ROS's sensor_msgs/Imu.
 *
 *  Axes as in types::Pose: unit x forward, y left, z up; world x north, y west, z up. NaN means unknown. */
struct Imu {
    static constexpr const char* type_name = "/insonify/Imu";

    Time time;
    glm::dquat orientation{Pose::unknown, Pose::unknown, Pose::unknown, Pose::unknown};
    glm::dmat3 cov_orientation = Pose::unknownMatrix();
    glm::dvec3 angular_velocity{Pose::unknown};
    glm::dmat3 cov_angular_velocity = Pose::unknownMatrix();
    glm::dvec3 linear_acceleration{Pose::unknown};
    glm::dmat3 cov_linear_acceleration = Pose::unknownMatrix();

    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "when the reading was true in the world"}, self.time);
        visit({"orientation", "1", "unit quaternion that turns the unit's vectors into the world"}, self.orientation);
        visit({"cov_orientation", "rad^2", "covariance of orientation, axis-angle in the unit"}, self.cov_orientation);
        visit({"angular_velocity", "rad/s", "angular rate, in the unit"}, self.angular_velocity);
        visit({"cov_angular_velocity", "rad^2/s^2", "covariance of the angular rate"}, self.cov_angular_velocity);
        visit({"linear_acceleration", "m/s^2", "specific force, in the unit: at rest +g upwards"},
              self.linear_acceleration);
        visit({"cov_linear_acceleration", "m^2/s^4", "covariance of the specific force"}, self.cov_linear_acceleration);
    }
};

}  // namespace insonify::types
