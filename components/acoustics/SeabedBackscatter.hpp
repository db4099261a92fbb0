#pragma once
#include <functional>
#include <string>

#include "components/acoustics/HalfSpace.hpp"
#include "components/acoustics/Seabed.hpp"

namespace insonify::acoustics {

/** Backscattering cross section of a seabed after APL-UW TR 9407 (1994), section IV.C: its rough interface (Kirchhoff's
 *  approximation near the vertical, composite roughness below, or an empirical law where it is very rough) and its
 *  volume. 10 to 100 kHz; about 3 dB for sands that are known well, 10 dB for rock. ACOUSTICS.md 3.5. */
class SeabedBackscatter {
public:
    /** At a frequency [kHz], in water of a speed of sound [m/s]. */
    SeabedBackscatter(const Seabed& seabed, double frequency_khz, double speed_of_sound);

    /** sigma_b at a grazing angle [rad], m^2 at 1 m for each m^2; below 0.001 deg that of 0.001 deg [1]. */
    double crossSection(double grazing) const;

    /** The two parts that crossSection() is the sum of [1]. */
    double roughInterface(double grazing) const;
    double volume(double grazing) const;
    /** What `roughInterface` is put together from [1]. */
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
    double slope_;              ///< s: rms slope of what is rougher than the wave [1].
    double structure_;          ///< q_c of Kirchhoff's approximation [1].
    double a_, b_;              ///< Of its closed form [1].
    double normal_reflection_;  ///< |R|^2 at normal incidence [1].
};

/** What lies outside of what the report covers: "750 kHz (10 to 100)"; empty when nothing does. */
std::string outsideSeabedModel(double frequency_khz, double speed_of_sound);

}  // namespace insonify::acoustics
