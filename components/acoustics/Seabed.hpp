#pragma once
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

}  // namespace insonify::acoustics
