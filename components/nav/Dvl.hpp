#pragma once
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "components/nav/ErrorModel.hpp"
#include "components/nav/Motion.hpp"
#include "types/geometry/Snapshot.hpp"
#include "types/samples/Dvl.hpp"

namespace insonify::nav {

/** The surroundings of a Doppler velocity log, for straight beams: the triangles of a scene including moved and
 *  deformed objects, or a level bottom. */
class Bottom {
public:
    /** @param height of a level bottom in the world [m]; none: no bottom */
    explicit Bottom(std::optional<double> height = {}) : height_(height) {}

    /** Replaces the bottom by the scene of this snapshot, and poses its meshes that deform. Other objects that are not
     *  moved are placed once per geometry. */
    void take(types::SnapshotPtr snapshot);
    /** Returns whether a place is under the water surface; true when the scene has no surface. */
    bool isUnderWater(const glm::dvec3& place) const;

    /** Returns the range from a place in the world along a unit vector [m]; none when nothing is within `farthest`. */
    std::optional<double> range(const glm::dvec3& from, const glm::dvec3& direction, double farthest) const;

private:
    /** The pose of an object, and its bounding box along the world's axes. */
    struct Placed {
        glm::dmat4 world_from_object{1};
        const types::Mesh* mesh = nullptr;  ///< Mesh of the geometry, or its posed copy.
        glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
    };
    void place(size_t object, const glm::dmat4& world_from_object, const types::Mesh& mesh);
    const types::Mesh& getMesh(size_t object) const;
    /** Returns the mesh of an object in the shape of the snapshot. */
    const types::Mesh& posed(const types::DeformedObject& deformed);
    std::optional<double> rangeOfScene(const glm::dvec3& from, const glm::dvec3& direction, double farthest) const;

    std::optional<double> height_;
    types::SnapshotPtr snapshot_;
    std::vector<Placed> placed_;           ///< One per object of the geometry.
    std::vector<size_t> changed_;          ///< Objects that are moved from their place in the geometry, or deformed.
    std::map<size_t, types::Mesh> posed_;  ///< Meshes of the objects that have been deformed.
};

/** Errors of the measurements of each beam. */
struct BeamErrors {
    double velocity_noise = 0;
    double scale_error = 0;
    double velocity_bias = 0;
    double range_noise = 0;
    double dropout = 0;

    static void describe(auto& self, auto& visit) {
        visit({"velocity_noise", "m/s", "deviation of each beam's velocity, from ping to ping", 0, 100},
              self.velocity_noise);
        visit({"scale_error", "1",
               "deviation of each beam's constant scale error: the long-term accuracy as a share of velocity", 0, 1},
              self.scale_error);
        visit({"velocity_bias", "m/s", "deviation of each beam's constant bias: the other long-term part", 0, 100},
              self.velocity_bias);
        visit({"range_noise", "m", "deviation of each beam's range, from ping to ping", 0, 1000}, self.range_noise);
        visit({"dropout", "1", "share of beams that are lost although the bottom is in reach", 0, 1}, self.dropout);
    }
};

/** A Janus configuration: four beams at an angle of `slant_deg` to an axis that looks down. */
struct DvlConfig {
    SensorConfig sensor{};
    double slant_deg = 30;
    double beam_azimuth_deg = 45;
    double min_altitude = 0.05;
    double max_altitude = 50;
    double speed_of_sound = 1500;
    std::optional<double> bottom_height{};
    BeamErrors errors{};

    static void describe(auto& self, auto& visit) {
        SensorConfig::describe(self.sensor, visit, "of the instrument in the body; without rotation it looks down",
                               "between pings; 0: a ping per pose");
        visit({"slant_deg", "deg", "angle of each beam to the instrument's axis", 5, 60}, self.slant_deg);
        visit({"beam_azimuth_deg", "deg",
               "of the first beam from ahead, positive to port; the others follow at 90 each", -360, 360},
              self.beam_azimuth_deg);
        visit({"min_altitude", "m", "min height above the bottom, along the axis; nearer beams are lost", 0, 1e4},
              self.min_altitude);
        visit({"max_altitude", "m", "max height above the bottom, along the axis; farther beams are lost", 1e-3, 1e4},
              self.max_altitude);
        visit({"speed_of_sound", "m/s", "reported with the velocities", 300, 2500}, self.speed_of_sound);
        visit({"bottom_height", "m",
               "of a level bottom in the world, if no scene is connected; absent: a scene is required", -1e5, 1e5},
              self.bottom_height);
        visit({"errors", "", "of its beams; absent: none"}, self.errors);
    }
    void check(types::Diagnostics& diagnostics) const {
        if (!(min_altitude < max_altitude)) diagnostics.push_back({"min_altitude", "is not below max_altitude"});
    }
};

constexpr size_t beam_count = types::Dvl::max_beams;
using BeamDirections = std::array<glm::dvec3, beam_count>;

/** Returns the unit vectors of the beams in the instrument: x forward, y left, z up [1]. */
BeamDirections janusBeams(double slant_deg, double azimuth_deg);

/** A velocity and its covariance, in the instrument. */
struct VelocitySolution {
    glm::dvec3 velocity;    ///< [m/s]
    glm::dmat3 covariance;  ///< [m^2/s^2]
};
/** Returns the least-squares fit of a velocity to the velocities along the beams; none with fewer than three good
 *  beams. For four beams of equal deviation s, the variances are s^2 / (2 sin^2 slant) across the axis and s^2 / (4
 *  cos^2 slant) along it. Source: Brokloff, "Matrix algorithm for Doppler sonar navigation", OCEANS 1994.
 *  @param velocities along the beams, NaN for a lost beam [m/s]
 *  @param variances of the velocities [m^2/s^2] */
std::optional<VelocitySolution> solveVelocity(const BeamDirections& beams,
                                              const std::array<double, beam_count>& velocities,
                                              const std::array<double, beam_count>& variances);

/** A Doppler velocity log that tracks the bottom. Its beams are lines: their width and the travel time of sound are not
 *  simulated. */
class Dvl {
public:
    explicit Dvl(const DvlConfig& config);
    /** Fills `reported` with one ping. With fewer than three good beams there is no bottom lock and no velocity. */
    void measure(const Motion& motion, const Bottom& bottom, types::Dvl& reported) const;

private:
    /** Returns the range of a beam [m]; NaN for a lost beam. */
    double range(size_t beam, const Motion& motion, const Bottom& bottom) const;
    double variance(double velocity) const;
    void solve(types::Dvl& reported) const;

    DvlConfig config_;
    BeamDirections beams_;
    double cosine_;                         ///< Cosine of the slant [1].
    std::array<double, beam_count> scale_;  ///< Scale error of each beam [1].
    std::array<double, beam_count> bias_;   ///< Bias of each beam [m/s].
};

/** Returns the velocity as Rock's DVL drivers report it: in the axes of the instrument, frame "dvl"; other fields are
 *  unknown. */
types::Pose getVelocity(const types::Dvl& dvl);

}  // namespace insonify::nav
