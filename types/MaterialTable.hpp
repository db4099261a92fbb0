#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "types/Geometry.hpp"

namespace insonify::types {

/** Gives `material` the Lambert parameter of a sediment at 100 kHz: fits to APL-UW TR 9407 over grazing angles of
 *  5 to 60 deg, held at or below energy conservation (1/pi, -5 dB); "mackenzie" is the -27 dB of Mackenzie (1961).
 *  False, and nothing changed, when there is none of that name. */
bool applySediment(std::string_view name, Material& material);

/** Gives `material` the pressure reflection R = (Z - Z0)/(Z + Z0) of a solid at normal incidence in sea water
 *  (Z0 = 1.5375 MRayl, typical values) and the Lambert parameter -9.23 dB + 20 log10|R| with which a sphere of it
 *  has the target strength of a smooth one. False, and nothing changed, when there is none of that name. */
bool applyMaterial(std::string_view name, Material& material);

std::vector<std::string> sedimentNames();  ///< From loud to quiet.
std::vector<std::string> materialNames();  ///< From high to low impedance.

}  // namespace insonify::types
