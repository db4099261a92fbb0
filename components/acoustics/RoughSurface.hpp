#pragma once
#include "components/acoustics/Matter.hpp"
#include "components/acoustics/Seabed.hpp"

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
    /** Return the mean square height of the waves longer, and shorter, than 2 pi / wave_number [m^2]. */
    double squareHeightBelow(double wave_number) const;
    double squareHeightAbove(double wave_number) const;
};

/** The backscatter of a rough solid at one frequency, by two scales (ACOUSTICS.md 3.11). Relief longer than three
 *  wavelengths reflects a lobe; shorter relief scatters diffusely. */
class RoughSurface {
public:
    /** @param solid ratios to the water
     *  @param wave_number of sound in the water [rad/m] */
    RoughSurface(const HalfSpace& solid, const Relief& relief, double wave_number);

    /** Returns the pressure reflection coefficient at normal incidence, by the impedance in the water, signed [1]. */
    double reflection() const { return reflection_; }
    /** Returns the share of the reflected energy that the lobe keeps, exp(-4 k^2 h^2) of the shorter relief [1]. */
    double lobeShare() const { return lobe_share_; }
    /** Returns the mean square slope of the lobe [1]. */
    double squareSlope() const { return square_slope_; }

    /** Returns the cross section of the shorter relief at a grazing angle [rad], without the lobe [m^2 at 1 m per m^2].
     *  It is perturbation(), but at most Lambert's law of the energy that the lobe has lost. */
    double diffuse(double grazing) const;
    /** Returns the cross section by the first order of small perturbations, unbounded [m^2 at 1 m per m^2]. */
    double perturbation(double grazing) const;

private:
    HalfSpace solid_;
    Relief relief_;
    double wave_number_, cut_;  ///< Wave numbers: in the water, and between longer and shorter relief [rad/m].
    double reflection_, lobe_share_, square_slope_, max_lambert_;
};

/** Returns the surface of a matter in water of a density [kg/m^3] and speed of sound [m/s]. The matter must have a
 *  roughness. */
RoughSurface makeRoughSurface(const MatterProperties& matter, double frequency_khz, double water_density,
                              double speed_of_sound);

}  // namespace insonify::acoustics
