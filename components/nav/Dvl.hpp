#pragma once
#include <array>

#include "components/nav/Bottom.hpp"
#include "components/nav/DvlConfig.hpp"
#include "components/nav/Motion.hpp"
#include "types/Dvl.hpp"

namespace insonify::nav {

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
types::Pose velocityOf(const types::Dvl& dvl);

}  // namespace insonify::nav
