#pragma once
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "components/sonar/echo/Interface.hpp"
#include "components/sonar/echo/WallLaws.hpp"
#include "components/sonar/plan/SonarConfig.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** A sample of a facet: the part of its plane that a sonar sees within a rectangle of azimuth and elevation. */
struct LobeSample {
    FacetRecord facet;
    glm::dvec3 normal, axis;                ///< Of the facet, in the axes of the direction, of any length.
    double range;                           ///< [m]
    double cos_az, sin_az, cos_el, sin_el;  ///< Direction of the sample's middle.
    double width = 0, height = 0;           ///< [rad]
    double bent = 0;                        ///< Cosine of a bent normal; 0: it is the plane's [1].

    /** Sets the direction, a unit vector. */
    void lookAlong(const glm::dvec3& direction);
};

/** What materials give back to a sonar (ACOUSTICS.md 3): by Lambert's law, or by a table, and by a lobe about the
 *  normal. */
struct MaterialLaws {
    std::vector<MaterialRecord> records;  ///< One for each material.
    std::vector<double> tables;           ///< sigma_b / cos(theta), BACKSCATTER_ENTRIES each [1].
    std::vector<WallLaw> walls;           ///< One for each material.
    std::optional<double> wavelength;     ///< None without a frequency [m].
    bool has_measured = false;            ///< A table is measured.
    bool has_seabeds = false;             ///< A table is that of APL-UW TR 9407.
    bool has_matter = false;              ///< A table is that of a rough solid.
    bool lacks_frequency = false;         ///< There are seabeds, which follow Lambert's law for want of a frequency.
    std::optional<double> sharp_turn;     ///< Edges of this turn and more echo themselves (3.12) [rad].
    std::string outside_validity;         ///< What lies outside of what TR 9407 covers; empty: nothing.

    bool hasLobes() const;
    /** Whether sound goes through a wall, or rings in one. */
    bool hasWalls() const;
    /** Whether any wall has returns that are apart in range, or a fill. */
    bool hasReturns() const;
    /** Leaves each wall that rings its first return; WallRays adds the others. */
    void takeReturnsApart();
    bool followsLambert(size_t material) const { return FOLLOWS_LAMBERT(records[material].law); }
    bool hasLobe(size_t material) const { return records[material].law.y > 0; }
    /** sigma_b / cos(theta) of a material at a cosine [1]; of one with a lobe, as the lobe is seen. */
    double overCosine(size_t material, double cosine, const LobeSlopes& slopes = {}) const;
    /** How the lobe of a material is seen in a sample of a facet. */
    LobeSlopes lobeSlopes(size_t material, const LobeSample& sample) const;
    /** The same of sound that comes and goes at other angles (ACOUSTICS.md 5.23): of what comes in at one cosine, over
     *  the other of them [1]. */
    struct Bistatic {
        double diffuse, lobe;
    };
    /** `half`: cosine between the normal and the middle of the two directions [1], in which the lobe is seen as given.
     */
    Bistatic bistatic(size_t material, double in, double out, double half, const LobeSlopes& slopes) const;
    /** Largest sigma_b / cos(theta) of any material but for its lobe [1]. */
    double loudest() const;
    /** The same of lobes alone, in samples that are so wide [1, rad]. */
    double loudestLobe(double sample_angle) const;
};

/** Of the physical model; `cerqueira2017` has reflectivities alone.
 *  @throws types::ConfigError as SonarConfig::speedOfSound() does. */
MaterialLaws makeMaterialLaws(const SonarConfig& config, const types::Geometry& geometry);

}  // namespace insonify::sonar
