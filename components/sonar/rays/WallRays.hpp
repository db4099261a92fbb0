#pragma once
#include <array>
#include <glm/vec3.hpp>

#include "components/sonar/rays/TileCells.hpp"
#include "components/sonar/ways/Mirrors.hpp"

namespace insonify::sonar {

/** Successive echoes from one hit of a ray, because sound rings in walls. */
class EchoTrain {
public:
    static constexpr size_t max_echoes = WallLaw::max_returns;  ///< [1]

    struct Echo {
        double late;    ///< Slant range beyond that of the surface [m].
        double weight;  ///< Share of the energy [1].
    };

    /** Makes a train of one echo without delay. */
    EchoTrain() { echoes_[0] = {0, 1}; }
    size_t size() const { return size_; }
    const Echo& operator[](size_t i) const { return echoes_[i]; }
    /** Returns the train of a wall whose returns follow each echo of this train at a spacing [m]. Echoes closer than
     *  `resolution` [m] merge, at the range of the first. Echoes beyond max_echoes are added to the last. The sum of
     *  the weights becomes the product of the sums. */
    EchoTrain then(const Returns& returns, double spacing, double resolution) const;
    void moveAway(double range) {
        for (size_t i = 0; i < size_; ++i) echoes_[i].late += range;
    }
    /** Subtracts from the first echo. */
    void take(double weight) { echoes_[0].weight -= weight; }
    void scale(double by) {
        for (size_t i = 0; i < size_; ++i) echoes_[i].weight *= by;
    }

private:
    void append(const Echo& echo, double resolution);

    size_t size_ = 1;
    std::array<Echo, max_echoes> echoes_;
};

/** Follows the rays of a tile through walls that ring and into bodies with a fill (ACOUSTICS.md 5.26). Surfaces are
 *  processed layer by layer, each layer once per echo. Allocates nothing. */
class WallRays {
public:
    static constexpr double min_passed = 1e-6;  ///< Share of the energy below which a ray ends: 60 dB [1].
    static constexpr double max_focus = 30;     ///< Bound at caustics, where ray theory gives infinity [1].

    /** `surface`: where rays end. `loss_of_water`: loss of energy in the sonar's water, one way [Np/m]. */
    WallRays(const EchoRules& rules, const RayVisibility& visibility, const PlacedScene& scene,
             const WaterMirror& surface, int max_walls, double loss_of_water)
        : rules_(rules),
          visibility_(visibility),
          scene_(scene),
          surface_(surface),
          max_walls_(max_walls),
          loss_of_water_(loss_of_water) {}

    /** Begins with the hits of a tile, the first return of which is deposited already. Returns whether any of them is a
     *  wall that rings or lets sound through. */
    bool begin(const TracedTile& tile, const TileRays& rays);
    /** Returns the next echoes to deposit, until the next call; null: there are no more. */
    const TracedTile* next();

private:
    static constexpr int max_bodies = 8;  ///< Max nested bodies [1].

    /** A fluid that sound is in. */
    struct Medium {
        double speed = 1;        ///< Relative to the water [1].
        double attenuation = 0;  ///< Of energy, one way, in excess of the water over the same slant range [Np/m].
    };
    /** A body that sound is in. */
    struct Body {
        uint32_t object;
        Medium fill;
    };
    /** A ray and its neighbours, sonar axes. */
    struct Ray {
        bool is_there = false;  ///< It has hit a surface in this layer.
        bool is_bent = false;
        glm::dvec3 from, way, look;          ///< [m], unit, unit: its initial direction.
        glm::dvec3 across[2];                ///< Normal to `look`.
        glm::dvec3 per_from[2], per_way[2];  ///< Change of `from` and `way` with the look direction [m], [1].
        double range = 0;                    ///< Slant range at `from` [m].
        double power = 1;                    ///< Share of the energy that returns [1].
        Medium medium;
        int bodies_count = 0;
        Body bodies[max_bodies];
        EchoTrain train, echoes;  ///< Sound that arrives; echoes that return from here.
        glm::dvec3 normal;        ///< Unit normal of the surface, against the ray.
        double cosine;            ///< Cosine of the angle between `normal` and the ray [1].
    };

    const WallLaw& wallOf(int i) const { return rules_.laws.walls[scene_.ranges[hits_.command[i]].material]; }
    uint32_t objectOf(int i) const { return scene_.commands[hits_.command[i]].object; }
    /** Returns the sine of the angle of incidence of the same wave in water [1]. */
    static double sineInWater(const Ray& ray) {
        return std::sqrt(std::max(1 - ray.cosine * ray.cosine, 0.0)) / ray.medium.speed;
    }
    static int bodyOf(const Ray& ray, uint32_t object);
    void meet(int i);
    void setEchoes(int i);
    /** Continues a ray through the wall that it has hit; drops a ray that ends there. */
    void pass(int i, PathRays& on);
    void enter(Ray& ray, uint32_t object, const WallLaw& wall) const;
    bool refract(int i, double speed);
    bool goOn();
    void countEchoes();
    const TracedTile* show(size_t echo);
    ApparentPlane apparent(const Ray& ray) const;

    const EchoRules& rules_;
    const RayVisibility& visibility_;
    const PlacedScene& scene_;
    const WaterMirror& surface_;
    int max_walls_;
    double loss_of_water_;
    int walls_ = 0;  ///< Walls that the rays of this layer have passed [1].
    size_t echo_ = 0, echoes_ = 0;
    TileHits hits_{}, shown_{};
    TracedTile tile_{};
    std::array<Ray, tile_samples> rays_;
    std::array<float, tile_samples> passed_{}, late_{};
    std::array<ApparentPlane, tile_samples> apparent_{};
};

}  // namespace insonify::sonar
