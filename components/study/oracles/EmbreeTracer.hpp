#pragma once
#include <memory>
#include <vector>

#include "components/sonar/config/SonarConfig.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::study {

/** Traces rays on the processor with Embree, on all cores: an independent program with the same physics, for comparison
 *  with the renderer. Its samples are cells of equal azimuth and elevation, 4 x 4 per packet. The energy of a cell's
 *  patch of plane is distributed over the ranges between those of the cell's four corners, which are exact. It is
 *  optimised: threads persist between pings, angles are tabulated, a ping allocates nothing.
 *
 *  Supports `physical` without absorption and `published`; planar beams; normal maps without mipmaps. Surfaces nearer
 *  than `range_min` hide those behind them. */
class EmbreeTracer {
public:
    /** Builds the tree of all triangles of the snapshot. Throws std::runtime_error if Embree fails. */
    explicit EmbreeTracer(const types::Snapshot& scene);
    ~EmbreeTracer();

    /** Makes the tables of a configuration: one ray for each of config.quality.rows over the aperture and
     *  columns_per_beam for each beam. */
    void prepare(const sonar::SonarConfig& config);

    /** Computes the energies E/S0 of one ping from `sonar`, [beam][bin], with the last prepared configuration. */
    void render(const types::Pose& sonar, std::vector<float>& energies);

    /** Only traces the rays of a ping; returns the number of hits [1]. */
    size_t traceOnly(const types::Pose& sonar);

    /** Returns the number of bins that the longest cell of the last ping covered, kappa of ACOUSTICS.md 4.5 [1]. */
    double kappaMax() const;

private:
    struct Fan;
    std::unique_ptr<Fan> fan_;
};

}  // namespace insonify::study
