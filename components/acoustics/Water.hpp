#pragma once
#include <optional>
#include <string>

#include "types/text/Describe.hpp"

namespace insonify::acoustics {

/** Formulas for the speed of sound: ACOUSTICS.md 2.1. */
enum class SoundSpeedLaw { Leroy, Mackenzie, Medwin, Coppens, ChenMillero, DelGrosso };

/** State of the water, which determines the speed of sound and the absorption. */
struct Water {
    double temperature_celsius = 10;  ///< ITS-90.
    double salinity_psu = 35;
    double depth = 0;
    double ph = 8;
    double latitude_deg = 45;
    SoundSpeedLaw sound_speed_law = SoundSpeedLaw::Leroy;
    std::optional<std::string> profile{};  ///< File with the speed of sound over depth, which bends the rays.

    static void describe(auto& self, auto& visit) {
        visit({"temperature_celsius", "degC", "temperature", -6, 50}, self.temperature_celsius);
        visit({"salinity_psu", "psu", "practical salinity, 0 for fresh water", 0, 50}, self.salinity_psu);
        visit({"depth", "m", "depth below the surface", 0, 12000}, self.depth);
        visit({"ph", "1", "acidity", 6, 10}, self.ph);
        visit({"latitude_deg", "deg", "latitude, for pressure at depth", -90, 90}, self.latitude_deg);
        visit({"sound_speed_law", "", "computes the speed of sound (Leroy, Robinson and Goldsmith 2008)"},
              self.sound_speed_law);
        visit({"profile", "", "CSV file with depth_m,sound_speed_m_s, which bends the rays; absent: straight"},
              self.profile);
    }
};

}  // namespace insonify::acoustics

template <>
struct insonify::types::EnumNames<insonify::acoustics::SoundSpeedLaw> {
    static constexpr std::string_view names[] = {"leroy",   "mackenzie",    "medwin",
                                                 "coppens", "chen_millero", "del_grosso"};
};
