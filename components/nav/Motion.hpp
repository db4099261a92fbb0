#pragma once
#include <array>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "types/Mount.hpp"
#include "types/Pose.hpp"
#include "types/RecurringDiagnostic.hpp"

namespace insonify::nav {

/** How a sensor moves at one moment. */
struct Motion {
    types::Time time;
    glm::dvec3 position{0};              ///< In the world [m].
    glm::dquat orientation{1, 0, 0, 0};  ///< Unit quaternion, sensor to world [1].
    glm::dvec3 velocity{0};              ///< In the world [m/s].
    glm::dvec3 acceleration{0};          ///< In the world, without gravity [m/s^2].
    glm::dvec3 angular_rate{0};          ///< In the sensor [rad/s].
    double interval = 0;                 ///< Mean time to the poses before and after it [s].
};

/** How a sensor that is fixed to a body moves, from the poses of the body: of three poses in a row the motion at the
 *  middle one, so that it is one pose late. Its stamp is that of the middle pose.
 *
 *  The sensor's place is taken as a parabola through the three, and so is its turn, as a rotation vector from the
 * middle one. With poses `h` seconds apart that leaves out h^2/6 of the third derivative in velocity, h^2/6 of the
 * second of the rate in the angular rate, and h^2/12 of the fourth derivative of the place in acceleration: at 100 Hz,
 * on a swell of 1 m and 6 s, 2e-5 m/s and 1e-5 m/s^2. What a lever arm adds needs no formula: it is in the sensor's
 * places. */
class MotionTracker {
public:
    static constexpr double longest_gap = 1;  ///< A longer pause between two poses is no motion [s].

    explicit MotionTracker(const types::Mount& mount = {}) : mount_(mount) {}

    /** Takes the next pose of the body, which must be usable (types::isUsable). Tells the motion at the one before,
     * once there are three, and if it is finite. A stamp that is not after the last is passed over; one that is more
     * than `longest_gap` earlier or later begins anew. A place far from the last is taken as motion, however fast. */
    std::optional<Motion> take(const types::Pose& body);

    /** What to tell of a pause before the pose that was taken last: at the first, and again only after ten poses that
     *  came in time (types::RecurringDiagnostic). Empty: nothing. */
    std::string takeWarning();

private:
    Motion middle() const;

    types::Mount mount_;
    std::array<types::Pose, 3> poses_;  ///< Of the sensor, the newest last.
    int count_ = 0;                     ///< Poses since it has begun, at most 3 [1].
    types::RecurringDiagnostic pauses_;
    std::string warning_;
};

/** When a measurement is due of those that come: the first on or after each multiple of a period, by their stamps. */
class Cadence {
public:
    /** @param period [s]; 0: each is due. */
    explicit Cadence(double period = 0) : period_(types::Time::fromSeconds(period).microseconds) {}
    bool isDue(types::Time time);

private:
    int64_t period_;  ///< [us]
    std::optional<int64_t> last_;
};

}  // namespace insonify::nav
