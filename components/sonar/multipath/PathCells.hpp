#pragma once
#include <atomic>
#include <glm/vec3.hpp>
#include <memory>

#include "components/sonar/bins/Estimators.hpp"
#include "components/sonar/bins/Truth.hpp"
#include "components/sonar/multipath/Mirrors.hpp"
#include "components/sonar/plan/Effect.hpp"
#include "components/sonar/rays/TileCells.hpp"

namespace insonify::sonar {

constexpr double edge_on = 1e-4;       ///< Cosine below which a surface gives no echo [1].
constexpr double reaching_back = 1.1;  ///< Cells beyond the range, up to this factor of it, may extend into it [1].

/** The directions of a rectangle of samples of a tile. */
struct CellAngles {
    glm::dvec3 middle, per_azimuth, per_elevation;  ///< Unit direction of the middle, and its derivatives [1].
    double width, height, lean;                     ///< [rad], [rad], dazimuth / delevation of its sides [1].
    double size, weighted;  ///< Solid angle, plain and weighted by the two-way pattern, in cells at elevation 0 [1].
    int cell;

    /** @param sample  its first sample in the tile
     *  @param merged  samples, a power of 2 [1] */
    CellAngles(const TracedView& view, const TracedTile& tile, int sample, int merged);
};

/** Inverse range of a path whose half is along a direction to a plane and from there to a focus, and its derivatives
 *  with the direction. */
struct HalfPath {
    double inverse, per_azimuth, per_elevation, nearest;  ///< [1/m], [1/m rad], [1/m rad], [1/m].
    double back;                                          ///< Distance from the plane to the focus [m].
    glm::dvec3 from_focus;                                ///< Unit.

    /** Adds a slant range to all of it [m]. */
    void moveAway(double late);
};

HalfPath computeHalfPath(const MirrorPlane& plane, const glm::dvec3& focus, const CellAngles& at);

/** Returns the plane of the triangle that ray `i` of a tile has hit, sonar axes. */
MirrorPlane planeMet(const PlacedScene& scene, const TileHits& hits, int i);

namespace {

/** Adds energies to bins that all threads share. */
#define HAVE_PHYSICAL
struct SharedBins : Bins {
    using Bins::Bins;
    void addToBin(uint cell, uint bin, double amount, double) const {
        if (!(amount > 0)) return;
        if (truth && !truth->keeps({object, EchoPart::no_triangle, path, cell, bin, quanta(amount), sine_elevation,
                                    sine_grazing}))
            return;
        std::atomic_ref(sums[size_t{cell} * bin_count + bin]).fetch_add(quanta(amount), relaxed);
        if (by_path) std::atomic_ref(by_path[size_t{cell} * bin_count + bin]).fetch_add(quanta(amount), relaxed);
        if (truth) truth->show(cell, bin, ObjectEcho::of(quanta(amount), sine_elevation, sine_grazing, object, 1));
    }
    PathTruth* truth = nullptr;  ///< Receives each echo's truth, with the next four values; null: none.
    uint32_t object = 0;
    uint8_t path = 0;  ///< As types::SonarTruth::path.
    double sine_elevation = 0,
           sine_grazing = 0;      ///< Sines of the elevation at the sonar and of the grazing angle at the object [1].
    uint64_t* by_path = nullptr;  ///< Additional sums, of the current kind of path; null: none.
    static constexpr std::memory_order relaxed = std::memory_order_relaxed;
#include "shaders/deposit.glsl"
};
#undef HAVE_PHYSICAL

/** Returns a quantum of the sums [sr]. */
inline double computeQuantum(const TracedPing& ping) {
    return ping.view.cells.cell() / (quanta_per_unit * ping.rules.strength_scale);
}

}  // namespace

/** Makes the effect of echoes via mirrors, in one or both directions (ACOUSTICS.md 5.23). Rays that first hit a mirror
 *  are followed further. Their next hit returns an echo at half of its two-way path. Echoes of all cells are summed in
 *  whole quanta, so their order is free. The plan has Pass::Paths and outlives the effect. Null in a build without
 *  rays. */
std::unique_ptr<PingEffect> makePathEchoes(const RenderPlan& plan, const types::Geometry& geometry);

}  // namespace insonify::sonar
