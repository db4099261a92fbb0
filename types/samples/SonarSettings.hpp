#pragma once
#include <cmath>
#include <cstdint>
#include <limits>

#include "types/Time.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/Describe.hpp"

namespace insonify::types {

/** The settings that a driver requests for a ping. NaN, or 0 for a count, leaves a setting unchanged. */
struct SonarSettings {
    static constexpr const char* type_name = "/insonify/SonarSettings";
    static constexpr double unset = std::numeric_limits<double>::quiet_NaN();

    Time time;
    double range = unset;
    double frequency_khz = unset;
    double speed_of_sound = unset;  ///< 0: the sonar's own again, as before a driver set it.
    double gain_db = unset;
    Angle bearing;
    Angle field_of_view;
    Angle beam_height;
    uint32_t bin_count = 0;
    uint32_t beam_count = 0;

    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "when the ping was asked for"}, self.time);
        visit({"range", "m", "slant range at which the last bin ends"}, self.range);
        visit({"frequency_khz", "kHz", "of the sonar"}, self.frequency_khz);
        visit({"speed_of_sound", "m/s", "by which the sonar turns time into range; 0: its own again"},
              self.speed_of_sound);
        visit({"gain_db", "dB", "of the receiver, after its TVG"}, self.gain_db);
        visit({"bearing", "rad", "of a scanning sonar's head, 0 ahead, positive to port"}, self.bearing);
        visit({"field_of_view", "rad", "from the first beam to the last"}, self.field_of_view);
        visit({"beam_height", "rad", "of a beam, in elevation"}, self.beam_height);
        visit({"bin_count", "1", "of a beam; 0: as it is"}, self.bin_count);
        visit({"beam_count", "1", "0: as it is"}, self.beam_count);
    }
};

}  // namespace insonify::types
