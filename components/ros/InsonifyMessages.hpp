#pragma once
// insonify_msgs: messages that ROS 2 lacks, and their conversions from samples. See Messages.hpp.
#include <string>
#include <vector>

#include "components/ros/MarineAcousticMessages.hpp"
#include "components/ros/Messages.hpp"
#include "types/samples/SonarElements.hpp"
#include "types/samples/SonarReturns.hpp"
#include "types/samples/SonarSettings.hpp"
#include "types/samples/SonarTruth.hpp"

namespace insonify::ros {

/** The ground truth of a ping's bins. Lists are beam-first: bin k of beam b is at b * bin_count + k. */
struct SonarTruth {
    static constexpr const char* type_name = "insonify_msgs/msg/SonarTruth";
    static constexpr const char* summary =
        "The ground truth of a ping's bins. Lists are beam-first: bin k of beam b is at b * bin_count + k.";
    Header header;
    int64_t bin_duration_us = 0;
    float sound_speed = 0;
    uint32_t bin_count = 0;
    std::vector<double> bearings;
    std::vector<std::string> objects;
    std::vector<float> elevation;
    std::vector<int32_t> object;
    std::vector<float> share;
    std::vector<uint32_t> hits;
    std::vector<float> grazing;
    std::vector<uint8_t> path;
    std::vector<uint8_t> shadow;

    friend bool operator==(const SonarTruth&, const SonarTruth&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"bin_duration_us", "us", "one-way travel time through one bin"}, self.bin_duration_us);
        visit({"sound_speed", "m/s"}, self.sound_speed);
        visit({"bin_count", "1", "bins per beam"}, self.bin_count);
        visit({"bearings", "rad", "of each beam, positive to port"}, self.bearings);
        visit({"objects", "", "names of all objects"}, self.objects);
        visit({"elevation", "rad", "positive up"}, self.elevation);
        visit({"object", "1", "index into `objects`; -1: none"}, self.object);
        visit({"share", "1", "of that object, or of the water, in the energy"}, self.share);
        visit({"hits", "1", "samples"}, self.hits);
        visit({"grazing", "rad"}, self.grazing);
        visit({"path", "1",
               "0: direct, 1: by the surface once, 2: twice, 3: bounced, 4: through a wall, 5: rung in a wall, 6: "
               "water"},
              self.path);
        visit({"shadow", "", "1: no echo of a surface, although nearer than the last"}, self.shadow);
    }
};

/** The first and the strongest return of each beam of a ping; NaN if the beam has none. */
struct SonarReturns {
    static constexpr const char* type_name = "insonify_msgs/msg/SonarReturns";
    static constexpr const char* summary =
        "The first and the strongest return of each beam of a ping; NaN if the beam has none.";
    Header header;
    std::vector<double> bearings;
    std::vector<float> first_range;
    std::vector<float> first_level;
    std::vector<float> first_elevation;
    std::vector<float> strongest_range;
    std::vector<float> strongest_level;
    std::vector<float> strongest_elevation;

    friend bool operator==(const SonarReturns&, const SonarReturns&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"bearings", "rad", "of each beam, positive to port"}, self.bearings);
        visit({"first_range", "m"}, self.first_range);
        visit({"first_level", "dB"}, self.first_level);
        visit({"first_elevation", "rad"}, self.first_elevation);
        visit({"strongest_range", "m"}, self.strongest_range);
        visit({"strongest_level", "dB"}, self.strongest_level);
        visit({"strongest_elevation", "rad"}, self.strongest_elevation);
    }
};

/** The signals of a straight array's elements for one ping, as complex baseband: sample i of element m is at [m *
 *  sample_count + i]. */
struct SonarElements {
    static constexpr const char* type_name = "insonify_msgs/msg/SonarElements";
    static constexpr const char* summary =
        "Complex baseband of the elements of a straight array: sample i of element m is at m * sample_count + i.";
    Header header;
    double sound_speed = 0;
    double wavelength = 0;
    double first_range = 0;
    double sample_spacing = 0;
    uint32_t sample_count = 0;
    std::vector<double> positions;
    std::vector<double> weights;
    std::vector<float> in_phase;
    std::vector<float> quadrature;

    friend bool operator==(const SonarElements&, const SonarElements&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"sound_speed", "m/s"}, self.sound_speed);
        visit({"wavelength", "m"}, self.wavelength);
        visit({"first_range", "m", "of the first sample"}, self.first_range);
        visit({"sample_spacing", "m"}, self.sample_spacing);
        visit({"sample_count", "1", "of each element"}, self.sample_count);
        visit({"positions", "m", "of each element, positive to port"}, self.positions);
        visit({"weights", "1", "of each element"}, self.weights);
        visit({"in_phase", "1/m"}, self.in_phase);
        visit({"quadrature", "1/m"}, self.quadrature);
    }
};

/** Settings that a driver requests from a sonar. NaN, or a count of 0, leaves a setting unchanged. */
struct SonarSettings {
    static constexpr const char* type_name = "insonify_msgs/msg/SonarSettings";
    static constexpr const char* summary =
        "Settings that a driver requests from a sonar. NaN, or a count of 0, leaves a setting unchanged.";
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
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"range", "m", "slant range at which the last bin ends"}, self.range);
        visit({"frequency_khz", "kHz"}, self.frequency_khz);
        visit({"speed_of_sound", "m/s"}, self.speed_of_sound);
        visit({"gain_db", "dB", "of the receiver"}, self.gain_db);
        visit({"bearing", "rad", "of the head, 0 ahead, positive to port"}, self.bearing);
        visit({"field_of_view", "rad"}, self.field_of_view);
        visit({"beam_height", "rad"}, self.beam_height);
        visit({"bin_count", "1"}, self.bin_count);
        visit({"beam_count", "1"}, self.beam_count);
    }
};

// Convert samples to messages and back without loss. Throw std::out_of_range for a time that ROS cannot represent, and
// std::invalid_argument for lists of unequal lengths.

void convert(const types::SonarTruth& truth, const std::string& frame_id, SonarTruth& message);
void convert(const types::SonarReturns& returns, const std::string& frame_id, SonarReturns& message);
void convert(const types::SonarElements& signals, const std::string& frame_id, SonarElements& message);
void convert(const types::SonarSettings& settings, const std::string& frame_id, SonarSettings& message);
void convert(const SonarTruth& message, types::SonarTruth& truth);
void convert(const SonarReturns& message, types::SonarReturns& returns);
void convert(const SonarElements& message, types::SonarElements& signals);
void convert(const SonarSettings& message, types::SonarSettings& settings);

}  // namespace insonify::ros
