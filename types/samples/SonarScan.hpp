#pragma once
// The two types in which Rock's older drivers log a sonar. toSonar() converts both to a ping.
#include <limits>

#include "types/samples/Sonar.hpp"

namespace insonify::types {

/** One beam of a scanning sonar, field for field Rock's base::samples::SonarBeam. */
struct SonarBeam {
    static constexpr const char* type_name = "/base/samples/SonarBeam";
    static constexpr bool shared = true;
    static constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

    Time time;
    Angle bearing;
    double sampling_interval = static_cast<double>(unknown);
    float speed_of_sound = unknown;
    float beamwidth_horizontal = unknown;
    float beamwidth_vertical = unknown;
    std::vector<uint8_t> beam;

    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "when the beam was true in the world"}, self.time);
        visit({"bearing", "rad", "centre of the beam, 0 ahead, positive to port"}, self.bearing);
        visit({"sampling_interval", "s", "two-way travel time through one bin"}, self.sampling_interval);
        visit({"speed_of_sound", "m/s", "speed of sound that turns time into range"}, self.speed_of_sound);
        visit({"beamwidth_horizontal", "rad", "opening of the beam across"}, self.beamwidth_horizontal);
        visit({"beamwidth_vertical", "rad", "opening along the device's z axis"}, self.beamwidth_vertical);
        visit({"beam", "1", "echo strength of each bin, 255 is full scale"}, self.beam);
    }
};

/** The beams of a fan from port to starboard, field for field Rock's base::samples::SonarScan. */
struct SonarScan {
    static constexpr const char* type_name = "/base/samples/SonarScan";
    static constexpr bool shared = true;

    Time time;
    std::vector<uint8_t> data;
    std::vector<Time> time_beams;
    uint16_t number_of_beams = 0;
    uint16_t number_of_bins = 0;
    Angle start_bearing;
    Angle angular_resolution;
    double sampling_interval = static_cast<double>(SonarBeam::unknown);
    float speed_of_sound = SonarBeam::unknown;
    Angle beamwidth_horizontal;
    Angle beamwidth_vertical;
    bool memory_layout_column = true;
    bool polar_coordinates = true;

    void forEachStamp(auto&& visit) {
        for (Time& stamp : time_beams) visit(stamp);
    }
    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "when the scan was true in the world"}, self.time);
        visit({"data", "1", "echo strengths, 255 is full scale"}, self.data);
        visit({"time_beams", "us", "start of each beam; 0: the beam is not set"}, self.time_beams);
        visit({"number_of_beams", "1", "beams"}, self.number_of_beams);
        visit({"number_of_bins", "1", "bins per beam"}, self.number_of_bins);
        visit({"start_bearing", "rad", "centre of the first beam, the one farthest to port"}, self.start_bearing);
        visit({"angular_resolution", "rad", "from one beam to the next, above 0"}, self.angular_resolution);
        visit({"sampling_interval", "s", "two-way travel time through one bin"}, self.sampling_interval);
        visit({"speed_of_sound", "m/s", "speed of sound that turns time into range"}, self.speed_of_sound);
        visit({"beamwidth_horizontal", "rad", "opening of one beam across the fan"}, self.beamwidth_horizontal);
        visit({"beamwidth_vertical", "rad", "opening along the device's z axis"}, self.beamwidth_vertical);
        visit({"memory_layout_column", "", "true: bin after bin, each of all beams; false: beam after beam"},
              self.memory_layout_column);
        visit({"polar_coordinates", "", "true: beams and bins; false: a picture"}, self.polar_coordinates);
    }
};

/** Converts a beam to a ping of one beam; 255 becomes 1. Throws std::logic_error for an invalid sampling interval. */
Sonar toSonar(const SonarBeam& beam);

/** Converts a scan to a ping; 255 becomes 1, and beams that are not set become NaN. Bearings decrease from
 *  `start_bearing`, as the beams of the scan do; in Rock's conversion they increase, which mirrors the fan. Throws
 *  std::logic_error for a picture, for data that do not match the counts, and for an invalid sampling interval. */
Sonar toSonar(const SonarScan& scan);

}  // namespace insonify::types
