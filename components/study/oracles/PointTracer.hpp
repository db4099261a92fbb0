#pragma once
#include <cstdint>
#include <vector>

#include "components/sonar/config/SonarConfig.hpp"
#include "components/study/oracles/RayTree.hpp"
#include "components/study/oracles/Workers.hpp"

namespace insonify::study {

/** Solves the active sonar equation by brute force, for scenes without a closed form. Points are drawn at random; the
 *  energy of each is added to the bin of its own range, in double. It shares only the equation with the renderer, E =
 *  sum of sigma_b / (cos(theta) r^2) dOmega: no footprint, no image, no slope.
 *
 *  A beam is divided into slightly randomised tiles. 16 rays sample each tile, four of them at its corners. If all hit
 *  the same triangle, the tile is filled with points of that triangle's plane. Else it is divided into 16 tiles, at
 *  most twice; if they still show more than one triangle, their random rays are summed.
 *
 *  With a beam pattern in azimuth, tiles are those of narrow strips all around, and each beam is the sum of the strips
 *  weighted by the mean of its pattern over them (ACOUSTICS.md 5.11). A pattern in elevation weights each point; a
 *  pulse is summed over bins (5.12); scattering water is received up to each point (3.9). */
class PointTracer {
public:
    explicit PointTracer(const types::Snapshot& scene) : tree_(scene) {}

    /** Returns the energies E/S0 of one ping from `sonar`, [beam][bin], from `up` times `across` tiles in each beam.
     *  Another seed draws other rays; the same seed gives the same sums on any number of threads. `config`: `physical`,
     *  planar, without absorption, `published` and layers of water.
     *  @throws std::invalid_argument if it has layers */
    std::vector<double> render(const types::Pose& sonar, const sonar::SonarConfig& config, int up, int across,
                               uint64_t seed);

    /** Number of rays traced and points drawn in the last ping [1]. */
    double rays() const { return rays_; }

private:
    RayTree tree_;
    Workers workers_;
    double rays_ = 0;
};

}  // namespace insonify::study
