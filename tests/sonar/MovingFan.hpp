#pragma once
// The fan of the tests of motion within a ping.
#include "components/sonar/config/SonarConfig.hpp"

namespace insonify::sonar {

/** Returns 40 beams of 1 deg to 300 m, with bins of 0.1 m at 1500 m/s, which follow motion within a ping by rays. */
inline SonarConfig movingFan() {
    SonarConfig config;
    config.range_rounding = RangeRounding::Exact;
    config.speed_of_sound = 1500;
    config.range = 300;
    config.bin_count = 3000;
    config.beam_count = 40;
    config.field_of_view_deg = 40;
    config.beam_height_deg = 10;
    config.visibility = Visibility::Cpu;
    config.quality.rows = 128;
    config.quality.columns_per_beam = 4;
    config.motion_in_ping = true;
    return config;
}

}  // namespace insonify::sonar
