#pragma once
#include "components/acoustics/HalfSpace.hpp"
#include "components/acoustics/Matter.hpp"

namespace insonify::acoustics {

/** The relief of a surface: Gaussian heights whose correlation falls as exp(-distance / length). */
struct Relief {
    double height;  ///< Rms [m].
    double length;  ///< Correlation length [m].

    /** Returns the spectrum at a wave number [rad/m]: h^2 L^2 / (2 pi) (1 + K^2 L^2)^(-3/2) [m^4]. Its integral over
     * all wave vectors is h^2. */
    double spectrum(double wave_number) const;
    /** Returns the mean square slope of all waves longer than 2 pi / wave_number, in both directions together [1]. */
    double squareSlopeBelow(double wave_number) const;
    /** Return the mean square height of longer and of shorter waves [m^2]. */
    double squareHeightBelow(double wave_number) const;
    double squareHeightAbove(double wave_number) const;
};

/** What a rough solid gives back at one frequency, by two scales (ACOUSTICS.md 3.11): a lobe, reflected by the relief
 *  that is longer than three wavelengths, and what shorter relief scatters diffusely. */
class RoughSurface {
public:
    /** @param solid ratios to the water
     *  @param wave_number of sound in the water [rad/m] */
    RoughSurface(const HalfSpace& solid, const Relief& relief, double wave_number);

    /** Pressure reflection coefficient at normal incidence, by the impedance in the water, signed [1]. */
    double reflection() const { return reflection_; }
    /** Share of the reflected energy that the lobe keeps, exp(-4 k^2 h^2) of the shorter relief [1]. */
    double lobeShare() const { return lobe_share_; }
    /** Mean square slope of the lobe [1]. */
    double squareSlope() const { return square_slope_; }
    /** Lambert parameter of all energy that the lobe has lost, the bound of diffuse() [1]. */
    double maxLambert() const { return max_lambert_; }

    /** Backscattering cross section of the shorter relief at a grazing angle [rad], without the lobe: first order of
     *  small perturbations, and at most Lambert's law of the energy that the lobe has lost [m^2 at 1 m per m^2]. */
    double diffuse(double grazing) const;
    /** Returns the first of the two: small perturbations, unbounded. */
    double perturbation(double grazing) const;

private:
    HalfSpace solid_;
    Relief relief_;
    double wave_number_, cut_;  ///< In the water, and between longer and shorter relief [rad/m].
    double reflection_, lobe_share_, square_slope_, max_lambert_;
};

/** Returns a surface of a matter in water of a density [kg/m^3] and speed of sound [m/s] at a frequency [kHz]. The
 *  matter must have a roughness. */
RoughSurface roughSurfaceOf(const MatterProperties& matter, double frequency_khz, double water_density,
                            double speed_of_sound);

}  // namespace insonify::acoustics
