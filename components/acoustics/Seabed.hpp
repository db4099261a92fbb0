#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace insonify::acoustics {

/** What the seabed model of APL-UW TR 9407 (1994, section IV) takes: its table 1. Ratios are to the water above. */
struct Seabed {
    double density_ratio = 1;       ///< rho, 1 to 3 [1].
    double speed_ratio = 1;         ///< nu, 0.8 to 3 [1].
    double loss = 0.01;             ///< delta: imaginary over real part of the wave number, above 0 to 0.1 [1].
    double volume = 0.002;          ///< sigma_2: scattering of the volume over its attenuation, 0 to 1 [1].
    double roughness = 0.002;       ///< w_2: spectrum of the relief at 1 rad/cm, above 0 to 1 [cm^4].
    double roughness_slope = 3.25;  ///< gamma: how the spectrum falls with the wave number, 2.4 to 3.9 [1].
};

/** By mean grain size [phi], equations 2 to 10 of the report: -1 (sandy gravel) to 9 (clay); beyond, that of the end.
 */
Seabed seabedOfGrainSize(double phi);
/** What lies outside -1 to 9 phi: "12 phi (-1 to 9)"; empty when nothing does. */
std::string outsideGrainSizes(double phi);

/** By name, the report's table 2; none for a name that it does not have. */
std::optional<Seabed> seabedNamed(std::string_view name);
/** Mean grain size of a name [phi]; none for rocks, cobble and gravel. */
std::optional<double> grainSizeNamed(std::string_view name);
std::vector<std::string> seabedNames();

}  // namespace insonify::acoustics
