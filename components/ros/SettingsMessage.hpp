#pragma once
// A message of our own: what a driver asks of a sonar. See GeometryMessages.hpp.
#include "components/ros/GeometryMessages.hpp"

namespace insonify::ros {

/** What is NaN, or 0 of a count, stays as it is. */
struct SonarSettings {
    static constexpr const char* type_name = "insonify_msgs/msg/SonarSettings";
    static constexpr const char* type_hash = "RIHS01_9825b87f8b15ebda7ee51d90fbeca98dc442c3244fa4a81f841a6f71c4c44fb0";
    Header header;
    double range = 0;
    double frequency_khz = 0;
    double speed_of_sound = 0;
    double gain_db = 0;
    double bearing = 0;
    double field_of_view = 0;
    double beam_height = 0;
    uint32_t bin_count = 0;
    uint32_t beam_count = 0;

    friend bool operator==(const SonarSettings&, const SonarSettings&) = default;
    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"header"}, self.header);
        visit(Field{"range", "m", "slant range at which the last bin ends"}, self.range);
        visit(Field{"frequency_khz", "kHz"}, self.frequency_khz);
        visit(Field{"speed_of_sound", "m/s"}, self.speed_of_sound);
        visit(Field{"gain_db", "dB", "of the receiver"}, self.gain_db);
        visit(Field{"bearing", "rad", "of the head, 0 ahead, positive to port"}, self.bearing);
        visit(Field{"field_of_view", "rad"}, self.field_of_view);
        visit(Field{"beam_height", "rad"}, self.beam_height);
        visit(Field{"bin_count", "1"}, self.bin_count);
        visit(Field{"beam_count", "1"}, self.beam_count);
    }
};

}  // namespace insonify::ros
