#pragma once
#include <optional>
#include <vector>

#include "components/sonar/plan/SonarConfig.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** What is behind a wall where that is neither water nor air (ACOUSTICS.md 5.26). */
struct WallFill {
    double speed_ratio = 1;  ///< Its speed of sound over that of the sonar's water [1].
    double attenuation = 0;  ///< Energy, one way [Np/m].
    double within = 1;       ///< Reflection of the wall from within over that from outside, of energy [1].
};

/** Returns of a wall that are apart in range: the energy of each, all of them together being 1; the first is that of
 * the face that sound meets first. */
using Returns = std::vector<float>;

/** What a material's shell does to sound (ACOUSTICS.md 3.10, 5.26). A material without one has an empty law. */
struct WallLaw {
    static constexpr size_t max_returns = 32;  ///< [1]

    double reflected = 1;       ///< Share of the energy that it reflects at normal incidence, all returns together [1].
    std::vector<float> passed;  ///< Share that goes through and back, over the cosine in water from 0 to 1; empty:
                                ///< nothing [1].
    double thickness = 0;       ///< [m]
    double speed_ratio = 1;     ///< Speed of sound of the wall over that of the water [1].
    Returns outside, inside;    ///< Reflected at its two faces; empty: they are in one bin.
    Returns behind;             ///< Those of an echo from behind, out and back through the wall; empty likewise.
    std::optional<WallFill> fill;  ///< None: water, or air, which nothing passes into.

    bool letsThrough() const { return !passed.empty(); }
    bool rings() const { return !outside.empty(); }
    /** Returns the share of energy that goes through and back at a cosine of incidence in water [1]. */
    double passedAt(double cosine) const;
    /** Slant range between two returns at a sine of incidence in water: thickness c cos(theta_wall) / c_wall, 0 beyond
     *  the critical angle [m]. */
    double spacing(double sine) const;
};

/** Returns the law of a material: an empty one without a shell, or for a sonar without a frequency. */
WallLaw makeWallLaw(const types::Material& material, const SonarConfig& config);

}  // namespace insonify::sonar
