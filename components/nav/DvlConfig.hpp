#pragma once
#include <optional>

#include "components/nav/SensorConfig.hpp"

namespace insonify::nav {

/** Errors of the measurements of each beam. */
struct BeamErrors {
    double velocity_noise = 0;
    double scale_error = 0;
    double velocity_bias = 0;
    double range_noise = 0;
    double dropout = 0;

    static void describe(auto& self, auto& visit) {
        visit({"velocity_noise", "m/s", "deviation of each beam's velocity, from ping to ping", 0, 100},
              self.velocity_noise);
        visit({"scale_error", "1",
               "deviation of each beam's constant scale error: the long-term accuracy as a share of velocity", 0, 1},
              self.scale_error);
        visit({"velocity_bias", "m/s", "deviation of each beam's constant bias: the other long-term part", 0, 100},
              self.velocity_bias);
        visit({"range_noise", "m", "deviation of each beam's range, from ping to ping", 0, 1000}, self.range_noise);
        visit({"dropout", "1", "share of beams that are lost although the bottom is in reach", 0, 1}, self.dropout);
    }
};

/** A Janus configuration: four beams at an angle of `slant_deg` to an axis that looks down. */
struct DvlConfig {
    SensorConfig sensor{};
    double slant_deg = 30;
    double beam_azimuth_deg = 45;
    double min_altitude = 0.05;
    double max_altitude = 50;
    double speed_of_sound = 1500;
    std::optional<double> bottom_height{};
    BeamErrors errors{};

    static void describe(auto& self, auto& visit) {
        SensorConfig::describe(self.sensor, visit, "of the instrument in the body; without rotation it looks down",
                               "between pings; 0: a ping per pose");
        visit({"slant_deg", "deg", "angle of each beam to the instrument's axis", 5, 60}, self.slant_deg);
        visit({"beam_azimuth_deg", "deg",
               "of the first beam from ahead, positive to port; the others follow at 90 each", -360, 360},
              self.beam_azimuth_deg);
        visit({"min_altitude", "m", "min height above the bottom, along the axis; nearer beams are lost", 0, 1e4},
              self.min_altitude);
        visit({"max_altitude", "m", "max height above the bottom, along the axis; farther beams are lost", 1e-3, 1e4},
              self.max_altitude);
        visit({"speed_of_sound", "m/s", "reported with the velocities", 1, 1e4}, self.speed_of_sound);
        visit({"bottom_height", "m",
               "of a level bottom in the world, if no scene is connected; absent: a scene is required", -1e5, 1e5},
              self.bottom_height);
        visit({"errors", "", "of its beams; absent: none"}, self.errors);
    }
    void check(types::Diagnostics& diagnostics) const {
        if (!(min_altitude < max_altitude)) diagnostics.push_back({"min_altitude", "is not below max_altitude"});
    }
};

}  // namespace insonify::nav
