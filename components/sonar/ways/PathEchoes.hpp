#pragma once
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/echo/BinLevels.hpp"
#include "components/sonar/echo/TruthGrid.hpp"
#include "components/sonar/rays/TileCells.hpp"
#include "components/sonar/ways/Mirrors.hpp"

namespace insonify::sonar {

/** What a direction is worth on the way out and on the way back (ACOUSTICS.md 5.9), and which cells hear it. */
class WayPatterns {
public:
    explicit WayPatterns(const RenderPlan& plan);

    /** A direction in sonar axes. */
    struct Way {
        double azimuth = 0;  ///< As cells have it: of cones their bearing [rad].
        double sine = 0;     ///< Of the elevation [1].
        bool heard = false;  ///< Not behind a straight array.
    };
    Way wayOf(const glm::dvec3& direction) const;
    /** Power that is sent along one way and heard along another, over what the cell that hears it makes of it in
     *  azimuth [1]. */
    double power(const Way& sent, const Way& heard) const;
    /** Whether both are within one beam. */
    bool inOneBeam(const Way& a, const Way& b) const;
    /** Calls use(cell) for each azimuth cell that a way lies in. */
    template <class Use>
    void eachCell(const Way& way, const Use& use) const {
        plan_.cells.eachAt(way.azimuth, use);
    }

private:
    double elevation(const std::vector<double>& table, double sine) const;
    double sentAzimuth(double azimuth) const;

    const RenderPlan& plan_;
    bool conical_, has_azimuth_;
    double reach_, beam_width_;
    std::vector<double> sent_, heard_;  ///< Powers in elevation, over its sine from -reach_ on [1].
    std::vector<double> azimuths_;      ///< Power that is sent, over azimuths from -pi on [1].
};

/** Echoes that come by way of mirrors, in one or both directions (ACOUSTICS.md 5.23): rays that meet a mirror before
 *  all else are followed on, and what they meet is heard at half of its way out and back. Echoes of all cells are
 *  summed in whole quanta, in any order. */
class PathEchoes {
public:
    /** Of a plan with Pass::Paths; it and the visibility, which has the geometry, must outlive it. */
    PathEchoes(const RenderPlan& plan, const types::Geometry& geometry, const RayVisibility& visibility);
    /** Once the visibility has another geometry. */
    void takeScene(const types::Geometry& geometry);

    /** With the quality that the plan has by now; `rules` and `view` must outlive it. Allocates. */
    void takeQuality(const EchoRules& rules, const CastView& view);
    /** Once a ping, once the visibility is placed. `tells`: by which ways echoes come is told of it. */
    void begin(const types::Snapshot& snapshot, bool tells);
    /** Takes away what the rays of a tile have met beyond the water surface. */
    void endAtSurface(const CastTile& tile, TileHits& hits) const;
    /** Follows tiles' rays on, of columns below `end_column`. Several threads may do so at a time; allocates nothing.
     */
    void trace(const PlacedScene& scene, std::span<const CastTile> tiles, int end_column);
    /** Once all tiles are traced: adds what a cell has heard to the intensities of its bins, those of the rules, which
     *  `levels` are of; whether there is any. */
    bool addTo(size_t cell, const BinLevels& levels, std::span<float> bins) const;
    /** For the truth, before addTo(): what a cell has heard directly, where its energies are known. Not by several
     *  threads. */
    void takeDirect(size_t cell, const BinLevels& levels, std::span<const float> bins);
    /** Once all cells are taken, and the rest of the truth is told. */
    void tell(types::SonarTruth& truth) const { truth_->tell(truth); }
    /** What does not reflect in this ping. */
    std::optional<LeftOut> leftOut() const { return water_.leftOut(); }

private:
    class Tracer;
    /** Of the sums [sr]. */
    double quantum() const;

    const RenderPlan& plan_;
    const RayVisibility& visibility_;
    const EchoRules* rules_ = nullptr;
    const CastView* view_ = nullptr;
    std::optional<WayPatterns> patterns_;
    WaterMirror water_;
    std::vector<double> reflected_;   ///< Of each command: share of the power that it reflects as a mirror [1].
    std::vector<uint64_t> sums_;      ///< [cell][bin], in quanta.
    std::optional<PathTruth> truth_;  ///< From the first ping on that tells it.
    bool tells_ = false;
};

}  // namespace insonify::sonar
