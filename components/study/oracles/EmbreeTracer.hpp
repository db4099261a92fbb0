#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "components/sonar/config/SonarConfig.hpp"
#include "components/study/oracles/RayTree.hpp"
#include "components/study/oracles/Workers.hpp"
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
