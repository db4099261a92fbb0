#pragma once
#include <array>
#include <functional>
#include <string>

#include "components/acoustics/Curve.hpp"
#include "components/acoustics/RoughSurface.hpp"

namespace insonify::acoustics {

/** Returns mu cos^2(theta) by Lambert's law, mu = 10^(lambert_db / 10) [m^2 at 1 m per m^2]. ACOUSTICS.md 3.1. */
double lambertSection(double lambert_db, double cos_incidence);
/** A surface that follows Lambert's law returns no more energy than it receives up to here, mu = 1/pi [dB].
 * ACOUSTICS.md 3.1. */
inline constexpr double max_lambert_db = -4.97;

/** The rms slopes [1] that determine the width of a surface's lobe about its normal. */
struct Slopes {
    double roughness = 0;                  ///< Slope of the micro-relief.
    double mesh = 0;                       ///< Slope from a facet of a mesh to the next.
    double wavelength = 0, cell_area = 1;  ///< [m], [m^2]: a smooth cell of area A spreads as lambda^2 / (4 pi A).

    /** Returns s^2, the sum of the three squares [1]. */
    double meanSquare() const;
};

/** Returns an object's cross section: Lambert's law plus the lobe of geometric optics about the normal [m^2 at 1 m per
 *  m^2], mu cos^2(theta) + |R|^2 sec^4(theta) / (4 pi s^2) exp(-tan^2(theta) / s^2). ACOUSTICS.md 3.6. */
double objectSection(double lambert_db, double reflection, double mean_square_slope, double cos_incidence);

/** Returns the backscatter of a flat rough solid at a grazing angle [rad]: its lobe plus its diffuse scattering [m^2 at
 *  1 m per m^2]. ACOUSTICS.md 3.11. */
double solidSection(const RoughSurface& surface, double grazing);

/** A table of a backscatter law in the form that an echo needs: sigma_b / cos(theta) over cos(theta), 1024 entries with
 *  straight lines between them, close to each other below a cosine of 1/16 and above 15/16. Grazing angles below 0.001
 *  deg have the value at 0.001 deg. From 0.2 deg of grazing on it is within 0.05 dB of the laws of seabeds, except
 * within 0.002 of the cosine of a kink, as at the critical angle of rock, where it is within 1 dB; and within 0.5 dB of
 * a measured law that changes by at most 1.5 dB per degree. ACOUSTICS.md 3.8. */
class BackscatterTable {
public:
    static constexpr int entries = 1024;

    /** @param section cross section over the grazing angle [rad], m^2 at 1 m per m^2 */
    explicit BackscatterTable(const std::function<double(double)>& section);

    /** Returns the cosine of incidence of an entry; the first has that of 0.001 deg of grazing [1]. */
    static double computeCosine(int entry);
    /** Returns the entries. */
    const std::array<double, entries>& values() const { return values_; }

private:
    std::array<double, entries> values_;
};

/** Reads measured strengths [dB] over grazing angles [deg] from a CSV file with header grazing_deg,strength_db.
 *  @throws types::ConfigError with file, line and column of every diagnostic. */
Curve readBackscatter(const std::string& file);
/** Returns the measured cross section at a grazing angle [rad], interpolated in decibels [m^2 at 1 m per m^2]. Outside
 *  the measured angles it is that of the nearer end. */
double measuredSection(const Curve& measured, double grazing);

}  // namespace insonify::acoustics
