#pragma once
#include <array>
#include <span>
#include <vector>

#include "components/sonar/multipath/Mirrors.hpp"
#include "components/sonar/multipath/WallRay.hpp"
#include "components/sonar/rays/TileCells.hpp"
#include "components/sonar/surfaces/MeshFacts.hpp"

namespace insonify::sonar {

/** Sound back and forth between flat, smooth surfaces behind walls (ACOUSTICS.md 5.26). */
struct Reverberation {
    bool is_there = false;
    /** For each material: paths by mirrors (5.23) include its reflections; empty: there are no such paths. */
    std::vector<bool> in_paths;
    int bounces = 0;  ///< Max reflections of these paths [1].
    /** For each material: share of the energy that it reflects like a mirror at normal incidence, all returns of its
     *  wall together [1]; 0: its lobe is wide, or it has none. */
    std::vector<double> mirrored;

    Reverberation() = default;
    /** Reverberation with a plan's walls, if a flat facet of the scene is one. `facets` has those of each mesh. */
    Reverberation(const RenderPlan& plan, const types::Geometry& geometry, std::span<const MeshFacts::Facets> facets);

    bool isInPaths(uint32_t material) const { return !in_paths.empty() && in_paths[material]; }
    static bool isFlat(const FacetRecord& facet) {
        return facet.first.x == 0 && facet.first.z == 0 && facet.second.x == 0 && facet.second.z == 0;
    }
};

/** Follows the rays of a tile through walls that ring, into bodies with a fill, and back and forth between walls
 *  (ACOUSTICS.md 5.26). Surfaces are processed layer by layer, each layer once per echo. Allocates nothing. */
class WallRays {
public:
    static constexpr double min_passed = WallRay::min_passed;  ///< [1]
    static constexpr int max_reflections = 16;  ///< Max reflections of a ray back and forth between walls [1].

    /** `surface`: where rays end. `loss_of_water`: loss of energy in the sonar's water, one way [Np/m]. */
    WallRays(const EchoRules& rules, const TracedView& view, const RayVisibility& visibility, const PlacedScene& scene,
             const WaterMirror& surface, const Reverberation& reverberation, int max_walls, double loss_of_water)
        : rules_(rules),
          view_(view),
          visibility_(visibility),
          scene_(scene),
          surface_(surface),
          reverberation_(reverberation),
          max_walls_(max_walls),
          water_{loss_of_water, rules.bins.bin_width / 2} {}

    /** Begins with the hits of a tile, the first return of which is deposited already. Returns whether any of them is a
     *  wall that rings or lets sound through. */
    bool begin(const TracedTile& tile, const TileRays& rays);
    /** Returns the next echoes to deposit, until the next call; null: there are no more. */
    const TracedTile* next();

private:
    struct Ray : WallRay {
        bool is_there = false;     ///< It has hit a surface in this layer.
        bool is_in_paths = false;  ///< Paths by mirrors (5.23) have all its walls and reflections.
        EchoTrain echoes;          ///< Echoes that return from here.
    };

    const WallLaw& getWall(int i) const { return rules_.laws.walls[scene_.ranges[hits_.command[i]].material]; }
    uint32_t getObject(int i) const { return scene_.commands[hits_.command[i]].object; }
    WallRay::Surface getSurface(int i) const {
        return {scene_.ranges[hits_.command[i]], hits_.triangle[i], getObject(i), getWall(i)};
    }
    void meet(int i);
    /** Continues a ray through the wall that it has hit; drops a ray that ends there. */
    void pass(int i, PathRays& on);
    /** Reflects a ray at the flat, smooth surface that it has hit; drops a ray that has hit another. */
    void reflect(int i, PathRays& on);
    /** Returns the share of the energy that the surface that a ray has hit reflects like a mirror [1]. */
    double mirrored(int i);
    void send(int i, PathRays& on) const;
    /** Moves all rays to their next surface by pass() or reflect(). Returns whether any ray is left. */
    bool advance(void (WallRays::*step)(int, PathRays&));
    bool goOn();
    /** Continues between the surfaces behind the last wall. Returns false, with the rays at that wall, at the end. */
    bool goBackAndForth();
    void countEchoes();
    const TracedTile* show(size_t echo);

    const EchoRules& rules_;
    const TracedView& view_;
    const RayVisibility& visibility_;
    const PlacedScene& scene_;
    const WaterMirror& surface_;
    const Reverberation& reverberation_;
    int max_walls_;
    WallRay::Water water_;
    int walls_ = 0;        ///< Walls that the rays of this layer have passed [1].
    int reflections_ = 0;  ///< Their reflections behind these walls [1].
    size_t echo_ = 0, echoes_ = 0;
    TileHits hits_{}, shown_{};
    TracedTile tile_{};
    std::array<Ray, tile_samples> rays_, rays_at_wall_;
    TileHits hits_at_wall_{};
    std::array<float, tile_samples> passed_{}, late_{};
    std::array<ApparentPlane, tile_samples> apparent_{};
};

}  // namespace insonify::sonar
