#pragma once
#include <optional>
#include <string>
#include <vector>

#include "components/sonar/Interface.hpp"
#include "components/sonar/SonarConfig.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** What materials give back to a sonar (ACOUSTICS.md 3): by Lambert's law, or by a table, and by a lobe about the
 *  normal. */
struct MaterialLaws {
    std::vector<MaterialRecord> records;  ///< One for each material.
    std::vector<double> tables;           ///< sigma_b / cos(theta), BACKSCATTER_ENTRIES each [1].
    std::optional<double> wavelength;     ///< None without a frequency [m].
    bool has_measured = false;            ///< A table is measured.
    bool has_seabeds = false;             ///< A table is that of APL-UW TR 9407.
    bool lacks_frequency = false;         ///< There are seabeds, which follow Lambert's law for want of a frequency.
    std::string outside_validity;         ///< What lies outside of what TR 9407 covers; empty: nothing.

    bool hasLobes() const;
    bool followsLambert(size_t material) const { return FOLLOWS_LAMBERT(records[material].law); }
    /** sigma_b / cos(theta) of a material at a cosine [1]; its lobe is widened by what the facet adds to its mean
     *  square slope [1], and by how wide the sample is [rad]. */
    double overCosine(size_t material, double cosine, double facet_slope, double sample_angle) const;
    /** The same of sound that comes and goes at other angles (ACOUSTICS.md 5.23): of what comes in at one cosine, over
     *  the other of them [1]. */
    struct Bistatic {
        double diffuse, lobe;
    };
    /** `half`: cosine between the normal and the middle of the two directions [1]. `mean_square_slope`: what facets
     *  and the sample add to that of the lobe [1]. */
    Bistatic bistatic(size_t material, double in, double out, double half, double mean_square_slope) const;
    /** Largest sigma_b / cos(theta) of any material but for its lobe [1]. */
    double loudest() const;
    /** The same of lobes alone, in samples that are so wide [1, rad]. */
    double loudestLobe(double sample_angle) const;
};

/** Of the physical model; `cerqueira2017` has reflectivities alone.
 *  @throws types::ConfigError as SonarConfig::speedOfSound() does. */
MaterialLaws makeMaterialLaws(const SonarConfig& config, const types::Geometry& geometry);

}  // namespace insonify::sonar
