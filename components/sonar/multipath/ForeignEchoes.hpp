#pragma once
#include <memory>
#include <span>

#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/rays/TileCells.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::sonar {

/** Scattering of the pulses of other sonars by surfaces (ACOUSTICS.md 5.29), in ray-traced pings: from the transmitter
 *  straight to the surface, and from there straight to the sonar. */
class ForeignEchoes {
public:
    virtual ~ForeignEchoes() = default;
    virtual void updateQuality() = 0;
    /** Begins a ping. The snapshot must outlive the ping. */
    virtual void begin(const types::Snapshot& snapshot) = 0;
    /** Adds the hits of the rays of tiles. Several threads call it, each with its own tiles. */
    virtual void follow(const TracedPing& ping, std::span<const TracedTile> tiles) = 0;
    /** Adds to the intensities of a cell's bins; returns whether any is above 0. Several threads call it. */
    virtual bool addEnergies(const TracedPing& ping, size_t cell, std::span<float> bins) = 0;
};

/** Makes them. The plan has `crosstalk` and outlives them. Null in a build without rays. */
std::unique_ptr<ForeignEchoes> makeForeignEchoes(const RenderPlan& plan);

}  // namespace insonify::sonar
