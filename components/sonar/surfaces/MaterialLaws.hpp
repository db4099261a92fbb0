#pragma once
#include <cmath>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "components/sonar/base/Interface.hpp"
#include "components/sonar/config/SonarConfig.hpp"
#include "components/sonar/surfaces/WallLaws.hpp"
#include "types/geometry/Geometry.hpp"
#include "types/geometry/VectorMath.hpp"

namespace insonify::sonar {

/** The arithmetic of backscatter that the processor shares with the compute shader. */
struct BackscatterCode {
    const double* entries;  ///< MaterialLaws::tables.
    double backscatterEntry(uint i) const { return entries[i]; }
    static double exp(float x) { return double{types::exponential(x)}; }
    static double sqrt(double x) { return std::sqrt(x); }
    static double min(double a, double b) { return a < b ? a : b; }
    static double max(double a, double b) { return a > b ? a : b; }
    static uint min(uint a, uint b) { return a < b ? a : b; }
#include "shaders/backscatter.glsl"
};

/** A sample of a facet: the part of its plane that a sonar sees within a rectangle of azimuth and elevation. */
struct LobeSample {
    FacetRecord facet;
    glm::dvec3 normal, axis;                ///< Normal and axis of the facet, in the axes of the direction, any length.
    double range;                           ///< [m]
    double cos_az, sin_az, cos_el, sin_el;  ///< Direction of the sample's middle.
    double width = 0, height = 0;           ///< [rad]
    double mapped = 0;                      ///< Cosine of a mapped normal; 0: the plane's [1].

    /** Sets the direction, a unit vector. */
    void lookAlong(const glm::dvec3& direction);
};

/** Backscatter of materials (ACOUSTICS.md 3): by Lambert's law, or by a table, and by a lobe about the normal. */
struct MaterialLaws {
    std::vector<MaterialRecord> records;  ///< One for each material.
    std::vector<double> tables;           ///< sigma_b / cos(theta), BACKSCATTER_ENTRIES each [1].
    std::vector<WallLaw> walls;           ///< One for each material.
    std::optional<double> wavelength;     ///< None without a frequency [m].
    bool has_measured = false;            ///< At least one table is measured.
    bool has_seabeds = false;             ///< At least one table is that of APL-UW TR 9407.
    bool has_matter = false;              ///< At least one table is that of a rough solid.
    bool lacks_frequency = false;  ///< There are seabeds that follow Lambert's law because the frequency is unknown.
    std::optional<double> sharp_turn;  ///< Edges with at least this turn have their own echoes (3.12) [rad].
    std::string outside_validity;      ///< Parameters outside the validity of TR 9407; empty: none.

    bool hasLobes() const;
    /** Returns whether sound passes through a wall, or rings in one. */
    bool hasWalls() const;
    /** Returns whether any wall has returns that are separate in range, or a fill. */
    bool hasReturns() const;
    /** Reduces each wall that rings to its first return; WallRays adds the others. */
    void separateReturns();
    bool followsLambert(size_t material) const { return FOLLOWS_LAMBERT(records[material].law); }
    bool hasLobe(size_t material) const { return records[material].law.y > 0; }
    /** Returns sigma_b / cos(theta) of a material at a cosine [1]; with a lobe, for the lobe's slopes. */
    double overCosine(size_t material, double cosine, const LobeSlopes& slopes = {}) const;
    /** Returns the slopes of a material's lobe in a sample of a facet. */
    LobeSlopes lobeSlopes(size_t material, const LobeSample& sample) const;
    /** Bistatic scattering, for different angles of incidence and scattering (ACOUSTICS.md 5.23): the share of the
     *  sound that arrives at one cosine, over the other cosine [1]. */
    struct Bistatic {
        double diffuse, lobe;
    };
    /** Returns the bistatic scattering. `half`: cosine between the normal and the middle of the two directions [1], for
     *  which the slopes are given. */
    Bistatic bistatic(size_t material, double in, double out, double half, const LobeSlopes& slopes) const;
    /** Returns the max sigma_b / cos(theta) of any material, without its lobe [1]. */
    double loudest() const;
    /** Returns the same for lobes only, in samples of an angular width [1, rad]. */
    double loudestLobe(double sample_angle) const;
};

/** Returns the laws of the physical model; `cerqueira2017` has reflectivities only.
 *  @throws types::ConfigError as SonarConfig::speedOfSound() does. */
MaterialLaws makeMaterialLaws(const SonarConfig& config, const types::Geometry& geometry);

}  // namespace insonify::sonar
