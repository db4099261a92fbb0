#pragma once
#include <memory>
#include <vector>

#include "components/sonar/plan/SonarConfig.hpp"
#include "types/Snapshot.hpp"

namespace insonify::study {

/** The same physics by casting rays on the processor (Embree), all cores: an independent program, and the answer to
 *  "why not just cast rays". Its samples are cells of equal azimuth and elevation, four by four to a packet; what a
 *  cell's patch of plane returns goes to the ranges between those of the cell's own four corners, each met exactly. As
 *  quick as rays get: threads are kept between pings, angles are tabulated, a ping allocates nothing.
 *  `physical` without absorption and `published`; planar beams; normal maps without mipmaps. What is nearer than
 *  `range_min` hides what lies behind it. */
class EmbreeCaster {
public:
    /** Builds the tree of all triangles as they lie in the snapshot. Throws std::runtime_error when Embree cannot. */
    explicit EmbreeCaster(const types::Snapshot& scene);
    ~EmbreeCaster();

    /** Makes the tables of a configuration: one ray for each of config.quality.rows over the aperture and
     *  columns_per_beam for each beam. */
    void prepare(const sonar::SonarConfig& config);

    /** Energies E/S0 of one ping from `sonar`, [beam][bin], with the configuration prepared last. */
    void render(const types::Pose& sonar, std::vector<float>& energies);

    /** Casts the rays of a ping and does nothing with them; how many met something [1]. */
    size_t castOnly(const types::Pose& sonar);

    /** Of the last ping: bins that the longest cell covered, kappa of ACOUSTICS.md 4.5 [1]. */
    double kappaMax() const;

private:
    struct Fan;
    std::unique_ptr<Fan> fan_;
};

}  // namespace insonify::study
