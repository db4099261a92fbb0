#pragma once
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "components/sonar/bins/Cells.hpp"
#include "components/sonar/rays/RayPaths.hpp"
#include "components/sonar/surfaces/WallLaws.hpp"

namespace insonify::sonar {

/** A ray through walls and fills, with its neighbours in direction (ACOUSTICS.md 5.26). Sonar axes. */
struct WallRay {
    static constexpr double min_passed = 1e-6;  ///< Share of the energy below which a ray ends: 60 dB [1].
    static constexpr double max_focus = 30;     ///< Bound at caustics, where ray theory gives infinity [1].
    static constexpr int max_bodies = 8;        ///< Max nested bodies [1].

    /** The water that a ray is in, and the length within which echoes merge. */
    struct Water {
        double loss;        ///< Loss of energy, one way [Np/m].
        double resolution;  ///< [m]
    };
    /** The surface that a ray meets. */
    struct Surface {
        const PlacedRun& run;
        uint32_t triangle, object;
        const WallLaw& wall;

        glm::dvec3 normal() const { return glm::normalize(turned(run, run.planes[triangle].normal)); }
    };
    /** A fluid that sound is in. */
    struct Medium {
        double speed = 1;  ///< Relative to the water [1].
        double attenuation =
            0;  ///< Attenuation of energy, one way, in excess of the water over the same slant range [Np/m].
    };
    /** A body that sound is in. */
    struct Body {
        uint32_t object;
        Medium fill;
    };

    bool is_bent = false;
    glm::dvec3 from{0}, direction{0}, look{0};  ///< [m], unit, unit: its initial direction.
    glm::dvec3 across[2];                       ///< Normal to `look`.
    glm::dvec3 per_from[2], per_direction[2];   ///< Change of `from` and `direction` with the look direction [m], [1].
    double range = 0;                           ///< Slant range at `from` [m].
    double power = 1;                           ///< Share of the energy that returns [1].
    Medium medium;
    int bodies_count = 0;
    Body bodies[max_bodies];
    EchoTrain train;        ///< Sound that arrives, out and back.
    glm::dvec3 normal{0};   ///< Unit normal of the surface, against the ray.
    double cosine = 1;      ///< Cosine of the angle between `normal` and the ray [1].
    double length_met = 0;  ///< Length of its path to the surface since the last surface [m].

    /** Starts at the sonar in a unit direction. */
    void begin(const glm::dvec3& initial);
    /** Returns the sine of the angle of incidence of the same wave in water [1]. */
    double sineInWater() const { return std::sqrt(std::max(1 - cosine * cosine, 0.0)) / medium.speed; }
    bool isWithin(uint32_t object) const { return getBody(object) >= 0; }
    /** Moves to a surface ahead with a unit normal to either side. */
    void meet(const glm::dvec3& unit_normal, double length);
    /** Returns the echoes of the surface that it has met, by the same path back. */
    EchoTrain getEchoes(const Surface& surface, const Water& water) const;
    /** Returns the echoes of a wall that rings, of sound that arrives as `train`. `spacing`: of its returns [m];
     *  `inset`: slant range from its inner face to its outer face for sound from within [m]. */
    static EchoTrain rung(const EchoTrain& train, const WallLaw& wall, bool from_within, double spacing, double inset,
                          double resolution);
    /** Passes the wall that it has met, and refracts where the fluid behind is another. Returns whether it continues.
     */
    bool pass(const Surface& surface, const Water& water);
    /** Reflects at a plane through its place. */
    void reflect(const glm::dvec3& unit_normal);
    /** Returns the plane of the surface that it has met as seen in its initial direction. */
    ApparentPlane apparent() const;

private:
    int getBody(uint32_t object) const;
    void enter(const Surface& surface, const Water& water);
    /** Refracts at the surface that it has met. Returns false if it is totally reflected. */
    bool refract(const Surface& surface, double speed);
};

}  // namespace insonify::sonar
