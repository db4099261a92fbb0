#pragma once
#include <array>
#include <cstddef>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "components/pose/SeaMotion.hpp"
#include "types/geometry/WorldFrame.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::pose {

/** The pose of the body at one time. R = Rz(yaw) Ry(pitch) Rx(roll), right-handed about the axes of the z-up world:
 *  positive pitch looks down, positive yaw turns to port. */
struct Waypoint {
    double time = 0;
    glm::dvec3 position{0};
    double roll_deg = 0;
    double pitch_deg = 0;
    double yaw_deg = 0;

    /** Returns the unit quaternion that rotates vectors of the body into the world. */
    glm::dquat orientation() const;

    static void describe(auto& self, auto& visit) {
        visit(
            {"time", "s", "since the start of the run, unless start, start_s or time_unit say otherwise", -1e19, 1e19},
            self.time);
        visit({"position", "m", "of the body in the world: north, west, up", -1e9, 1e9}, self.position);
        visit({"roll_deg", "deg", "about x, positive lowers starboard", -360, 360}, self.roll_deg);
        visit({"pitch_deg", "deg", "about y, positive looks down", -360, 360}, self.pitch_deg);
        visit({"yaw_deg", "deg", "about z, positive turns to port", -360, 360}, self.yaw_deg);
    }
};

enum class TimeUnit { Seconds, Milliseconds, Microseconds, Nanoseconds };

/** What a trajectory begins with at the start of the run. */
enum class TrajectoryStart { Run, FirstPose };

/** The clock of the times of a trajectory. */
struct TrajectoryTimes {
    std::optional<TimeUnit> time_unit = {};
    TrajectoryStart start = TrajectoryStart::Run;
    std::optional<double> start_s = {};

    static void describe(auto& self, auto& visit) {
        visit({"time_unit", "",
               "of the times: s, ms, us or ns; absent: that of times since 1970 where the first is one of after 1973, "
               "else s"},
              self.time_unit);
        visit({"start", "", "run: times count from the start of the run; first_pose: the run starts at the first time"},
              self.start);
        visit({"start_s", "s",
               "time of the trajectory at the start of the run, the same for trajectories of one clock; absent: 0",
               -1e10, 1e10},
              self.start_s);
    }
    void check(types::Diagnostics& diagnostics) const;
    /** Returns the unit of a trajectory whose first time is `first`. */
    TimeUnit findUnit(double first) const;
    /** Returns a time [unit] of a trajectory whose first time is `first` [unit] as a time of the run [s]. */
    double inRun(double time, double first) const;

    bool operator==(const TrajectoryTimes&) const = default;
};

/** The axes of a file's poses. */
inline constexpr types::Field world_frame_of_file{
    "world_frame", "", "axes of the file's poses: as_is, x north, y west, z up; enu as ROS has it; or ned"};

/** The source of a trajectory: either a file or waypoints. */
struct TrajectoryConfig {
    std::optional<std::string> file;
    std::vector<Waypoint> waypoints;
    bool loop = false;
    bool smooth = false;
    std::optional<SeaMotionConfig> motion = {};
    TrajectoryTimes times = {};
    types::WorldFrame world_frame = types::WorldFrame::AsIs;

    static void describe(auto& self, auto& visit) {
        visit({"file", "",
               "CSV with header time,x,y,z,qw,qx,qy,qz in [s] or time_unit, [m], [1]; or a file of TUM or EuRoC"},
              self.file);
        visit({"waypoints", "", "instead of a file; a single one is a fixed pose"}, self.waypoints);
        TrajectoryTimes::describe(self.times, visit);
        visit(world_frame_of_file, self.world_frame);
        visit({"loop", "", "whether the trajectory restarts at its first stamp after the last; else it ends there"},
              self.loop);
        visit({"smooth", "",
               "a natural cubic spline through the stamps, whose accelerations do not jump; else straight lines "
               "with corners"},
              self.smooth);
        visit({"motion", "", "heave, roll and pitch of a carrier on waves, on top of the trajectory; absent: none"},
              self.motion);
    }
    /** Requires exactly one source, and increasing times of waypoints. */
    void check(types::Diagnostics& diagnostics) const;
};

/** A natural cubic spline: a curve through its knots whose second derivatives do not jump and are zero at its ends.
 *  Source: Press et al., "Numerical Recipes", 3rd edition, section 3.3. */
class Spline {
public:
    static constexpr size_t columns = 7;
    using Row = std::array<double, columns>;
    /** A point of the curve, and its time derivative. */
    struct Point {
        Row value{}, rate{};
    };

    /** @param times strictly increasing [s], at least two
     *  @param rows one per time */
    Spline(std::vector<double> times, std::vector<Row> rows);

    /** Returns the point at `time` [s] in the segment that ends with knot number `knot`, 1 to the last. */
    Point at(size_t knot, double time) const;

private:
    std::vector<double> times_;
    std::vector<Row> rows_;
    std::vector<Row> curvatures_;  ///< Second derivatives at the knots.
};

/** A path through the world. Between stamps the position is linear and the orientation a slerp along the shorter way;
 *  outside the stamps both stay constant. A smooth trajectory is a natural cubic spline through the stamps, of
 *  positions and of the components of quaternions, which are normalised. Immutable. */
class Trajectory {
public:
    struct Stamp {
        double time = 0;                     ///< Since the start of the run [s].
        glm::dvec3 position{0};              ///< In the world [m].
        glm::dquat orientation{1, 0, 0, 0};  ///< Unit quaternion, body to world [1].
    };

    /** @param stamps at least one, at strictly increasing times
     *  @throws std::invalid_argument for other stamps. */
    explicit Trajectory(std::vector<Stamp> stamps, bool smooth = false);
    /** @param times the clock of the stamps */
    Trajectory(const std::vector<Stamp>& stamps, bool smooth, const TrajectoryTimes& times);
    explicit Trajectory(const std::vector<Waypoint>& waypoints, bool smooth = false, const TrajectoryTimes& times = {});

    /** Reads a file, in the form that its content shows: CSV with header `time,x,y,z,qw,qx,qy,qz`; TUM, without a
     * header and separated by spaces: `time x y z qx qy qz qw`; EuRoC's ground truth, whose header begins with
     * `#timestamp`: times in ns, places, quaternions with w first, and columns that are ignored. Lines of the last two
     * that begin with # are comments. Normalises quaternions and skips blank lines.
     *  @param frame axes of the poses
     *  @throws types::ConfigError with line and column of every diagnostic: a field that is missing, superfluous or not
     *  a finite number, a time that does not increase, a quaternion shorter than 1e-6. */
    static Trajectory fromFile(const std::filesystem::path& file, bool smooth = false,
                               const TrajectoryTimes& times = {}, types::WorldFrame frame = types::WorldFrame::AsIs);

    /** Returns the pose of "body" in frame "world" at `time` [s] since the start of the run. It has a velocity in the
     *  world [m/s] and an angular velocity in the body [rad/s], both zero outside the stamps. Does not set
     *  Pose::time. */
    types::Pose at(double time) const;
    /** Returns the time of a looped trajectory for a time of the run [s]: unchanged before the first stamp, else from
     *  the first stamp up to the last. */
    double inLoop(double time) const;

    const std::vector<Stamp>& stamps() const { return stamps_; }
    /** Returns the unit in which the times were given. */
    TimeUnit timeUnit() const { return unit_; }
    /** Returns how many quaternions of the file had a length that differs from 1 by more than 1 %. */
    size_t oddLengths() const { return odd_lengths_; }

private:
    /** Sets pose and velocities on the spline, in the segment that ends with stamp number `stamp`. */
    void placeOnSpline(size_t stamp, double time, types::Pose& pose) const;

    std::vector<Stamp> stamps_;
    std::optional<Spline> spline_;
    TimeUnit unit_ = TimeUnit::Seconds;
    size_t odd_lengths_ = 0;
};

}  // namespace insonify::pose

template <>
struct insonify::types::EnumNames<insonify::pose::TimeUnit> {
    static constexpr std::string_view names[] = {"s", "ms", "us", "ns"};
};

template <>
struct insonify::types::EnumNames<insonify::pose::TrajectoryStart> {
    static constexpr std::string_view names[] = {"run", "first_pose"};
};
