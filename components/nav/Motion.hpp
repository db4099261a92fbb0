#pragma once
#include <array>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "types/samples/Pose.hpp"
#include "types/text/Notice.hpp"

namespace insonify::nav {

/** The motion of a sensor at one time. */
struct Motion {
    types::Time time;
    glm::dvec3 position{0};              ///< In the world [m].
    glm::dquat orientation{1, 0, 0, 0};  ///< Unit quaternion, sensor to world [1].
    glm::dvec3 velocity{0};              ///< In the world [m/s].
    glm::dvec3 acceleration{0};          ///< In the world, without gravity [m/s^2].
    glm::dvec3 angular_rate{0};          ///< In the sensor [rad/s].
    double interval = 0;                 ///< Mean time to the poses before and after it [s].
};

/** Computes the motion of a sensor that is fixed to a body from the poses of the body. Three consecutive poses give the
 *  motion at the middle pose, with its stamp, so the motion is one pose late.
 *
 *  Position, and rotation as a rotation vector from the middle pose, are parabolas through the three poses. With poses
 *  `h` seconds apart this omits h^2/6 of the third derivative in velocity, h^2/6 of the second derivative of the rate
 *  in the angular rate, and h^2/12 of the fourth derivative in acceleration: at 100 Hz, on a swell of 1 m and 6 s, 2e-5
 *  m/s and 1e-5 m/s^2. The sensor's positions contain the effect of a lever arm. */
class MotionTracker {
public:
    static constexpr double longest_gap = 1;  ///< Max time between two poses of a motion [s].

    explicit MotionTracker(const types::Mount& mount = {}) : mount_(mount) {}

    /** Takes the next pose of the body, which must be usable (types::isUsable). Returns the motion at the pose before,
     *  once there are three poses and if it is finite. Ignores a stamp that is not after the last, unless it is more
     *  than `longest_gap` earlier. Such a stamp, and one more than `longest_gap` later, starts anew. A jump counts as
     *  motion, at any speed. */
    std::optional<Motion> take(const types::Pose& body);

    /** Returns the warning about a pause before the last pose; empty without one. It is repeated only after ten poses
     *  in time (types::RecurringDiagnostic). */
    std::string consumeWarning();

private:
    Motion middle() const;

    types::Mount mount_;
    std::array<types::Pose, 3> poses_;  ///< Poses of the sensor, the newest last.
    int count_ = 0;                     ///< Number of poses since the start, at most 3 [1].
    types::RecurringDiagnostic pauses_;
    std::string warning_;
};

/** Selects the measurements that are due: the first on or after each multiple of a period, by their stamps. */
class Cadence {
public:
    /** @param period [s]; 0: every measurement is due */
    explicit Cadence(double period = 0) : period_(types::Time::fromSeconds(period).microseconds) {}
    bool isDue(types::Time time);

private:
    int64_t period_;  ///< [us]
    std::optional<int64_t> last_;
};

}  // namespace insonify::nav
