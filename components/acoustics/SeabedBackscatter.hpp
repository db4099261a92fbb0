#pragma once
#include <functional>
#include <string>

#include "components/acoustics/HalfSpace.hpp"
#include "components/acoustics/Seabed.hpp"

namespace insonify::acoustics {

/** Backscattering cross section of a seabed after APL-UW TR 9407 (1994), section IV.C: its rough interface and its
 *  volume. The interface uses Kirchhoff's approximation near the vertical and composite roughness elsewhere; a very
 *  rough interface uses an empirical law. Valid for 10 to 100 kHz; accurate to about 3 dB for well-known sands, 10 dB
 *  for rock. ACOUSTICS.md 3.5. */
class SeabedBackscatter {
public:
    /** @param speed_of_sound in the water [m/s] */
    SeabedBackscatter(const Seabed& seabed, double frequency_khz, double speed_of_sound);

    /** Returns sigma_b at a grazing angle [rad], m^2 at 1 m per m^2 [1]. Angles below 0.001 deg count as 0.001 deg. */
    double crossSection(double grazing) const;

    /** Return the two parts whose sum is crossSection() [1]. */
    double roughInterface(double grazing) const;
    double volume(double grazing) const;
    /** Return the laws that `roughInterface` blends [1]. */
    double kirchhoff(double grazing) const;
    double compositeRoughness(double grazing) const;
    double largeRoughness(double grazing) const;

private:
    double perturbation(double grazing) const;
    double volumeOfAPlane(double grazing) const;
    double shadowing(double grazing) const;
    double overSlopes(const std::function<double(double)>& section, double grazing) const;

    Seabed seabed_;
    double wave_number_;        ///< k in the water [1/cm].
    double alpha_;              ///< gamma / 2 - 1 [1].
    double slope_;              ///< s: rms slope of the relief that the wave finds smooth [1].
    double structure_;          ///< q_c of Kirchhoff's approximation [1].
    double a_, b_;              ///< a and b of the closed form of Kirchhoff's approximation [1].
    double normal_reflection_;  ///< |R|^2 at normal incidence [1].
};

/** Returns the inputs outside the report's range, such as "750 kHz (10 to 100)"; empty when all are inside. */
std::string outsideSeabedModel(double frequency_khz, double speed_of_sound);

}  // namespace insonify::acoustics
