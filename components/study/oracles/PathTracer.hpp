#pragma once
#include <cstdint>
#include <vector>

#include "components/sonar/config/SonarConfig.hpp"
#include "components/study/oracles/RayTree.hpp"
#include "components/study/oracles/Workers.hpp"

namespace insonify::study {

/** Computes echoes of surfaces under a flat, still water surface by brute force. Rays are drawn at random, uniformly in
 *  azimuth and in the sine of elevation; each echo is added to the bin of its own range, in double. A point is received
 *  along each pair of the direct path and the path by the surface, out and back (ACOUSTICS.md 5.23). Both paths must be
 *  free, in the fan and within the aperture. */
class PathTracer {
public:
    explicit PathTracer(const types::Snapshot& scene);

    /** Returns the energies E/S0 of one ping from `sonar`, [beam][bin], from `up` times `across` tiles of 16 rays in
     *  each beam. Another seed draws other rays. `config` as for EmbreeTracer, with a surface and one bounce. */
    std::vector<double> render(const types::Pose& sonar, const sonar::SonarConfig& config, int up, int across,
                               uint64_t seed);

    /** Number of rays traced in the last ping, including the rays that test whether a path is free [1]. */
    double rays() const { return rays_; }

private:
    RayTree tree_;
    Workers workers_;
    double surface_;  ///< z of the water surface about the tree's origin [m].
    double rays_ = 0;
};

}  // namespace insonify::study
