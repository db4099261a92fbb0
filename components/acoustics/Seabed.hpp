#pragma once
#include <complex>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace insonify::acoustics {

/** The parameters of the seabed model of APL-UW TR 9407 (1994, section IV, table 1). Ratios are to the water above. */
struct Seabed {
    double density_ratio = 1;       ///< rho, 1 to 3 [1].
    double speed_ratio = 1;         ///< nu, 0.8 to 3 [1].
    double loss = 0.01;             ///< delta: imaginary over real part of the wave number, above 0 to 0.1 [1].
    double volume = 0.002;          ///< sigma_2: scattering of the volume over its attenuation, 0 to 1 [1].
    double roughness = 0.002;       ///< w_2: spectrum of the relief at 1 rad/cm, above 0 to 1 [cm^4].
    double roughness_slope = 3.25;  ///< gamma: how the spectrum falls with the wave number, 2.4 to 3.9 [1].
};

/** Returns the seabed of a mean grain size [phi], by equations 2 to 10 of the report. Clamps it to -1 (sandy gravel)
 *  and 9 (clay). */
Seabed seabedOfGrainSize(double phi);
/** Returns a text such as "12 phi (-1 to 9)" for a grain size outside -1 to 9 phi; empty when it is inside. */
std::string outsideGrainSizes(double phi);

/** Returns the seabed of a name of the report's table 2; none for an unknown name. */
std::optional<Seabed> seabedNamed(std::string_view name);
/** Returns the mean grain size of a name [phi]; none for rocks, cobble and gravel. */
std::optional<double> grainSizeNamed(std::string_view name);
std::vector<std::string> seabedNames();

/** A fluid that fills the space below a plane. The ratios are to the water above [1]. */
struct HalfSpace {
    double density_ratio = 1, speed_ratio = 1;
    double loss = 0;  ///< delta: imaginary over real part of the wave number [1].
};
HalfSpace halfSpace(const Seabed& seabed);

/** Returns kappa = (1 + i delta) / nu: the wave number in the half-space over that in the water [1]. */
std::complex<double> waveNumberRatio(const HalfSpace& half_space);
/** Returns Rayleigh's reflection coefficient of the sound pressure at a grazing angle [rad], with loss. A fast
 *  half-space reflects totally below its critical angle arccos(1 / nu). ACOUSTICS.md 3.7. */
std::complex<double> halfSpaceReflection(const HalfSpace& half_space, double grazing);
/** Returns Y at a grazing angle [rad]: a slightly rough surface of spectrum W [m^4] scatters
 *  4 k^4 sin^4 |Y|^2 W(2 k cos) back (Kuo 1964; ACOUSTICS.md 3.5). */
std::complex<double> roughnessAmplitude(const HalfSpace& half_space, double grazing);

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
