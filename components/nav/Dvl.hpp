#pragma once
#include <array>

#include "components/nav/Bottom.hpp"
#include "components/nav/DvlConfig.hpp"
#include "components/nav/Motion.hpp"
#include "types/Dvl.hpp"

namespace insonify::nav {

constexpr size_t beam_count = types::Dvl::max_beams;
using BeamDirections = std::array<glm::dvec3, beam_count>;

/** Unit vectors of the beams in the instrument: x forward, y left, z up [1]. */
BeamDirections janusBeams(double slant_deg, double azimuth_deg);

/** A velocity and its covariance, in the instrument. */
struct VelocitySolution {
    glm::dvec3 velocity;    ///< [m/s]
    glm::dmat3 covariance;  ///< [m^2/s^2]
};
/** The velocity that fits those along the beams best: least squares over the good ones, of which there must be three.
 *  For four of equal deviation s it has variances s^2 / (2 sin^2 slant) across the axis and s^2 / (4 cos^2 slant) along
 *  it. Source: Brokloff, "Matrix algorithm for Doppler sonar navigation", OCEANS 1994.
 *  @param velocities along the beams, NaN for a lost one [m/s]; @param variances of them [m^2/s^2]. */
std::optional<VelocitySolution> solveVelocity(const BeamDirections& beams,
                                              const std::array<double, beam_count>& velocities,
                                              const std::array<double, beam_count>& variances);

/** A Doppler velocity log that tracks the bottom. Its beams are lines: what their width adds is not simulated, and they
 *  all hear the bottom at the time of the ping. */
class Dvl {
public:
    explicit Dvl(const DvlConfig& config);
    /** Fills `told` with one ping. With fewer than three good beams there is no bottom lock, and no velocity. */
    void measure(const Motion& motion, const Bottom& bottom, types::Dvl& told) const;

private:
    /** Range of a beam, NaN where it is lost [m]. */
    double range(size_t beam, const Motion& motion, const Bottom& bottom) const;
    double variance(double velocity) const;
    void solve(types::Dvl& told) const;

    DvlConfig config_;
    BeamDirections beams_;
    double cosine_;                         ///< Of the slant [1].
    std::array<double, beam_count> scale_;  ///< Error of each beam's [1].
    std::array<double, beam_count> bias_;   ///< Of each beam [m/s].
};

/** The velocity as Rock's drivers of such logs tell it: in the axes of the instrument, frame "dvl"; the rest unknown.
 */
types::Pose velocityOf(const types::Dvl& dvl);

}  // namespace insonify::nav
