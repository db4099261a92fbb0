#pragma once
#include <memory>
#include <span>

#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/rays/TileCells.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** What surfaces scatter of the pulses of other sonars (ACOUSTICS.md 5.29), in pings that are ray-traced: from the
 *  transmitter straight to the surface, and from there straight to the sonar. */
class ForeignEchoes {
public:
    virtual ~ForeignEchoes() = default;
    virtual void takeQuality() = 0;
    /** Begins a ping. The snapshot stays until its end. */
    virtual void begin(const types::Snapshot& snapshot) = 0;
    /** Adds what the rays of tiles have met. Several threads call it, each with tiles of its own. */
    virtual void follow(const CastPing& ping, std::span<const CastTile> tiles) = 0;
    /** Adds to the intensities of a cell's bins; returns whether any is above 0. Several threads call it. */
    virtual bool addEnergies(const CastPing& ping, size_t cell, std::span<float> bins) = 0;
};

/** The plan has `crosstalk` and outlives what is made. Null in a build without rays. */
std::unique_ptr<ForeignEchoes> makeForeignEchoes(const RenderPlan& plan);

}  // namespace insonify::sonar
