#pragma once
#include <memory>
#include <vector>

#include "components/sonar/SonarConfig.hpp"
#include "types/Snapshot.hpp"

namespace insonify::study {

/** The same physics by casting rays on the processor (Embree), all cores: an independent program, and the answer to
 *  "why not just cast rays". Shares no code with the renderer, but its estimate: energies converge to the truth at the
 *  same rate; rays find triangles in float, everything after is in
 *  double. `physical` without absorption, normal maps and `published`; planar beams of a regular fan. */
class EmbreeCaster {
public:
    /** Builds the tree of all triangles as they lie in the snapshot. */
    explicit EmbreeCaster(const types::Snapshot& scene);
    ~EmbreeCaster();

    /** Energies E/S0 of one ping from `sonar`, [beam][bin], with one ray for each cell of a grid of
     *  config.quality.rows over the aperture and columns_per_beam for each beam, spread over the ranges that it covers.
     */
    void render(const types::Pose& sonar, const sonar::SonarConfig& config, std::vector<float>& energies);

    /** Of the last ping: bins that the longest cell covered, kappa of ACOUSTICS.md 4.5 [1]. */
    double kappaMax() const { return kappa_max_; }

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
    double kappa_max_ = 0;
};

}  // namespace insonify::study
