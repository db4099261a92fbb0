#pragma once
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "types/samples/Pose.hpp"

namespace insonify::types {

/** The measurement of one ping of a Doppler velocity log over the bottom. Rock has no type for it, only the velocity as
 *  a RigidBodyState; the fields are those of marine_acoustic_msgs/Dvl.
 *
 *  The axes are those of the instrument: x forward, y left, z up; its beams look down. NaN means unknown, for lost
 *  beams and without bottom lock. Lists are empty or have an element for each beam, at most four. */
struct Dvl {
    static constexpr const char* type_name = "/insonify/Dvl";
    static constexpr bool shared = true;
    static constexpr size_t max_beams = 4;

    Time time;
    glm::dvec3 velocity{Pose::unknown};
    glm::dmat3 cov_velocity = Pose::unknownMatrix();
    double altitude = Pose::unknown;
    double speed_of_sound = 1500;
    std::vector<glm::dvec3> beam_directions;
    std::vector<double> beam_ranges;
    std::vector<double> beam_velocities;
    std::vector<double> beam_velocity_variances;

    /** Returns whether the velocity over the bottom is known. */
    bool hasBottomLock() const { return std::isfinite(velocity.x + velocity.y + velocity.z); }
    /** Returns the number of beams with an echo [1]. */
    size_t goodBeams() const {
        size_t good = 0;
        for (const double range : beam_ranges) good += std::isfinite(range);
        return good;
    }
    const char* diagnostic() const {
        if (beam_directions.size() > max_beams) return "has more than four beams";
        const size_t beams = beam_directions.size();
        return beam_ranges.size() == beams && beam_velocities.size() == beams && beam_velocity_variances.size() == beams
                   ? nullptr
                   : "has other numbers of ranges or velocities than of beams";
    }
    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "at which the velocity holds"}, self.time);
        visit({"velocity", "m/s", "of the instrument over the bottom"}, self.velocity);
        visit({"cov_velocity", "m^2/s^2", "covariance of velocity"}, self.cov_velocity);
        visit({"altitude", "m", "over the bottom, along the axis of the instrument"}, self.altitude);
        visit({"speed_of_sound", "m/s", "that the instrument takes for its ranges and velocities"},
              self.speed_of_sound);
        visit({"beam_directions", "1", "unit vectors"}, self.beam_directions);
        visit({"beam_ranges", "m", "along each beam; NaN: a lost beam"}, self.beam_ranges);
        visit({"beam_velocities", "m/s", "of the instrument along each beam, positive towards the bottom"},
              self.beam_velocities);
        visit({"beam_velocity_variances", "m^2/s^2", "of each beam's velocity"}, self.beam_velocity_variances);
    }
};
using DvlPtr = std::shared_ptr<const Dvl>;

}  // namespace insonify::types
