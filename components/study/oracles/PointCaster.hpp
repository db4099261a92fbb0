#pragma once
#include <cstdint>
#include <vector>

#include "components/sonar/plan/SonarConfig.hpp"
#include "components/study/oracles/RayTree.hpp"
#include "components/study/oracles/Workers.hpp"

namespace insonify::study {

/** The active sonar equation by brute force, for scenes without a closed form: points drawn at random, the energy of
 *  each to the bin of its own range, in double. With the renderer it has only the equation in common, E = sum of
 *  sigma_b / (cos(theta) r^2) dOmega: no footprint, no image, no slope.
 *
 *  A beam is parted into tiles, a little at random. 16 rays look at each, four of them at its corners; where all meet
 *  the same triangle, the tile is filled with points of that triangle's plane, else it is parted into 16 and these are
 *  looked at in turn, twice over; what still shows more than one triangle then is the sum of rays drawn in it.
 *
 *  With a beam pattern in azimuth the tiles are those of narrow strips all around, and each beam is the sum of the
 *  strips by the mean of its pattern over them (ACOUSTICS.md 5.11); a pattern in elevation weighs each point; a pulse
 *  is summed over bins (5.12); water that scatters is heard up to each point (3.9). */
class PointCaster {
public:
    explicit PointCaster(const types::Snapshot& scene) : tree_(scene) {}

    /** Energies E/S0 of one ping from `sonar`, [beam][bin]: of `up` times `across` tiles in each beam. Another seed
     *  draws other rays; the same gives the same sums on any number of threads. `config`: `physical`, planar, without
     *  absorption, `published` and layers of water.
     *  @throws std::invalid_argument where it has layers */
    std::vector<double> render(const types::Pose& sonar, const sonar::SonarConfig& config, int up, int across,
                               uint64_t seed);

    /** Cast in the last ping, and points drawn [1]. */
    double rays() const { return rays_; }

private:
    RayTree tree_;
    Workers workers_;
    double rays_ = 0;
};

}  // namespace insonify::study
