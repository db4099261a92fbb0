#pragma once
#include <cstdint>
#include <vector>

#include "components/sonar/plan/SonarConfig.hpp"
#include "components/study/oracles/RayTree.hpp"
#include "components/study/oracles/Workers.hpp"

namespace insonify::study {

/** Echoes of surfaces under a flat, still water surface by brute force: rays drawn at random in equal shares of
 *  azimuth and of the sine of elevation, each echo to the bin of its own range, in double. A point is heard along each
 *  pair of the direct way and the way by the surface, out and back (ACOUSTICS.md 5.23), where both ways are free, in
 *  the fan and within the aperture. */
class PathCaster {
public:
    explicit PathCaster(const types::Snapshot& scene);

    /** Energies E/S0 of one ping from `sonar`, [beam][bin]: of `up` times `across` tiles of 16 rays in each beam.
     *  Another seed draws other rays. `config` as for EmbreeCaster, with a surface and one bounce. */
    std::vector<double> render(const types::Pose& sonar, const sonar::SonarConfig& config, int up, int across,
                               uint64_t seed);

    /** Cast in the last ping, those that look for what hides a way among them [1]. */
    double rays() const { return rays_; }

private:
    RayTree tree_;
    Workers workers_;
    double surface_;  ///< Its z about the tree's origin [m].
    double rays_ = 0;
};

}  // namespace insonify::study
