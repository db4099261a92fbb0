#pragma once
#include <array>
#include <functional>
#include <string>

#include "components/acoustics/Curve.hpp"
#include "components/acoustics/RoughSurface.hpp"

namespace insonify::acoustics {

/** Lambert's law: mu cos^2(theta), mu = 10^(lambert_db / 10) [m^2 at 1 m for each m^2]. ACOUSTICS.md 3.1. */
double lambertSection(double lambert_db, double cos_incidence);

/** What makes the lobe of a surface as wide as it is: rms slopes [1], all of facets that are steeper than the wave. */
struct Slopes {
    double roughness = 0;                  ///< Of the micro-relief.
    double mesh = 0;                       ///< From a facet of a mesh to the next.
    double wavelength = 0, cell_area = 1;  ///< [m], [m^2]: a smooth cell of this area spreads as lambda^2 / (4 pi A).

    /** s^2, of all three [1]. */
    double meanSquare() const;
};

/** Two terms for objects: Lambert's law, and the lobe of geometric optics about the normal [m^2 at 1 m for each m^2]:
 *  mu cos^2(theta) + |R|^2 sec^4(theta) / (4 pi s^2) exp(-tan^2(theta) / s^2). ACOUSTICS.md 3.6. */
double objectSection(double lambert_db, double reflection, double mean_square_slope, double cos_incidence);

/** Returns what a flat rough solid gives back at a grazing angle [rad]: its lobe and what it scatters
 *  [m^2 at 1 m for each m^2]. ACOUSTICS.md 3.11. */
double solidSection(const RoughSurface& surface, double grazing);

/** A law of backscatter as what an echo needs of it: sigma_b / cos(theta) over cos(theta), with straight lines between
 *  256 entries; nearer than 0.001 deg to grazing that of 0.001 deg. ACOUSTICS.md 3.8. */
class BackscatterTable {
public:
    static constexpr int entries = 256;

    /** Of a cross section over the grazing angle [rad], m^2 at 1 m for each m^2. */
    explicit BackscatterTable(const std::function<double(double)>& section);

    /** Entry i is for cos(theta) = i / 255; the first for the sine of 0.001 deg. */
    const std::array<double, entries>& values() const { return values_; }

private:
    std::array<double, entries> values_;
};

/** A measured strength: levels [dB] over grazing angles [deg], from a CSV file with header grazing_deg,strength_db.
 *  @throws types::ConfigError with file, line and column of every diagnostic. */
Curve readBackscatter(const std::string& file);
/** Its cross section at a grazing angle [rad]: straight lines in decibels, the nearer end's beyond what was measured
 *  [m^2 at 1 m for each m^2]. */
double measuredSection(const Curve& measured, double grazing);

}  // namespace insonify::acoustics
