#pragma once
// ROS 2 messages of marine_acoustic_msgs 2, field for field: see Messages.hpp.
#include <cstdint>
#include <string>
#include <vector>

#include "components/ros/Messages.hpp"

namespace insonify::ros {

/** Lists may be empty (unknown) or hold one value (the same for all beams). */
struct PingInfo {
    static constexpr const char* type_name = "marine_acoustic_msgs/msg/PingInfo";
    float frequency = 0;
    float sound_speed = 0;
    std::vector<float> tx_beamwidths;
    std::vector<float> rx_beamwidths;

    friend bool operator==(const PingInfo&, const PingInfo&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"frequency", "Hz", "0: unknown"}, self.frequency);
        visit({"sound_speed", "m/s"}, self.sound_speed);
        visit({"tx_beamwidths", "rad", "across the plane of the fan, -3 dB"}, self.tx_beamwidths);
        visit({"rx_beamwidths", "rad", "in the plane of the fan, -3 dB"}, self.rx_beamwidths);
    }
};

struct SonarImageData {
    static constexpr const char* type_name = "marine_acoustic_msgs/msg/SonarImageData";
    static constexpr const char* constants =
        "uint32 DTYPE_UINT8=0\nuint32 DTYPE_INT8=1\nuint32 DTYPE_UINT16=2\nuint32 DTYPE_INT16=3\nuint32 "
        "DTYPE_UINT32=4\n"
        "uint32 DTYPE_INT32=5\nuint32 DTYPE_UINT64=6\nuint32 DTYPE_INT64=7\nuint32 DTYPE_FLOAT32=8\n"
        "uint32 DTYPE_FLOAT64=9\n";
    static constexpr uint32_t uint8 = 0, uint16 = 2, uint32 = 4, float32 = 8, float64 = 9;
    bool is_bigendian = false;
    uint32_t dtype = uint8;
    uint32_t beam_count = 0;
    std::vector<uint8_t> data;

    friend bool operator==(const SonarImageData&, const SonarImageData&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"is_bigendian"}, self.is_bigendian);
        visit({"dtype", "1", "one of the constants"}, self.dtype);
        visit({"beam_count", "1", "beams"}, self.beam_count);
        visit({"data"}, self.data);
    }
};

/** stamp is the time of transmission. */
struct ProjectedSonarImage {
    static constexpr const char* type_name = "marine_acoustic_msgs/msg/ProjectedSonarImage";
    Header header;
    PingInfo ping_info;
    std::vector<Vector3> beam_directions;
    std::vector<float> ranges;
    SonarImageData image;

    friend bool operator==(const ProjectedSonarImage&, const ProjectedSonarImage&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"ping_info"}, self.ping_info);
        visit({"beam_directions", "1", "unit vectors"}, self.beam_directions);
        visit({"ranges", "m", "centres of the bins"}, self.ranges);
        visit({"image"}, self.image);
    }
};

/** Sample i is at the range (i + sample0) * sound_speed / (2 * sample_rate). */
struct RawSonarImage {
    static constexpr const char* type_name = "marine_acoustic_msgs/msg/RawSonarImage";
    Header header;
    PingInfo ping_info;
    float sample_rate = 0;
    uint32_t samples_per_beam = 0;
    uint32_t sample0 = 0;
    std::vector<float> tx_delays;
    std::vector<float> tx_angles;
    std::vector<float> rx_angles;
    SonarImageData image;

    friend bool operator==(const RawSonarImage&, const RawSonarImage&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"ping_info"}, self.ping_info);
        visit({"sample_rate", "Hz"}, self.sample_rate);
        visit({"samples_per_beam", "1"}, self.samples_per_beam);
        visit({"sample0", "1", "number of the first sample"}, self.sample0);
        visit({"tx_delays", "s", "of each beam"}, self.tx_delays);
        visit({"tx_angles", "rad", "of each beam"}, self.tx_angles);
        visit({"rx_angles", "rad", "of each beam, positive to starboard as in SonarDetections"}, self.rx_angles);
        visit({"image"}, self.image);
    }
};

struct DetectionFlag {
    static constexpr const char* type_name = "marine_acoustic_msgs/msg/DetectionFlag";
    static constexpr const char* constants =
        "uint8 DETECT_OK=0\nuint8 DETECT_BAD_SONAR=1\nuint8 DETECT_BAD_FILTER=2\nuint8 DETECT_BAD_USER=4\n";
    static constexpr uint8_t ok = 0, bad_sonar = 1, bad_filter = 2;
    uint8_t flag = ok;

    friend bool operator==(const DetectionFlag&, const DetectionFlag&) = default;
    static void describe(auto& self, auto& visit) { visit({"flag", "1", "0: good"}, self.flag); }
};

struct SonarRanges {
    static constexpr const char* type_name = "marine_acoustic_msgs/msg/SonarRanges";
    Header header;
    PingInfo ping_info;
    std::vector<DetectionFlag> flags;
    std::vector<float> transmit_delays;
    std::vector<float> intensities;
    std::vector<Vector3> beam_unit_vec;
    std::vector<float> ranges;

    friend bool operator==(const SonarRanges&, const SonarRanges&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"ping_info"}, self.ping_info);
        visit({"flags"}, self.flags);
        visit({"transmit_delays", "s"}, self.transmit_delays);
        visit({"intensities", "1"}, self.intensities);
        visit({"beam_unit_vec", "1"}, self.beam_unit_vec);
        visit({"ranges", "m"}, self.ranges);
    }
};

/** stamp is the start of transmission. Angles are those of a sonar that looks down. */
struct SonarDetections {
    static constexpr const char* type_name = "marine_acoustic_msgs/msg/SonarDetections";
    Header header;
    PingInfo ping_info;
    std::vector<DetectionFlag> flags;
    std::vector<float> two_way_travel_times;
    std::vector<float> tx_delays;
    std::vector<float> intensities;
    std::vector<float> tx_angles;
    std::vector<float> rx_angles;

    friend bool operator==(const SonarDetections&, const SonarDetections&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"ping_info"}, self.ping_info);
        visit({"flags"}, self.flags);
        visit({"two_way_travel_times", "s"}, self.two_way_travel_times);
        visit({"tx_delays", "s", "after the stamp"}, self.tx_delays);
        visit({"intensities", "1"}, self.intensities);
        visit({"tx_angles", "rad", "along the track, positive forward"}, self.tx_angles);
        visit({"rx_angles", "rad", "across the track, positive to starboard"}, self.rx_angles);
    }
};

/** Axes: x forward, z along the instrument's look direction. */
struct Dvl {
    static constexpr const char* type_name = "marine_acoustic_msgs/msg/Dvl";
    static constexpr const char* constants =
        "uint8 DVL_MODE_BOTTOM=1\nuint8 DVL_MODE_WATER=2\nuint8 DVL_TYPE_PISTON=0\nuint8 DVL_TYPE_PHASED_ARRAY=1\n";
    static constexpr uint8_t bottom = 1, piston = 0;
    static constexpr size_t beams = 4;
    Header header;
    uint8_t velocity_mode = bottom;
    uint8_t dvl_type = piston;
    Vector3 velocity;
    std::array<double, 9> velocity_covar{};
    double altitude = 0, course_gnd = 0, speed_gnd = 0;
    uint8_t num_good_beams = 0;
    float sound_speed = 0;
    bool beam_ranges_valid = false, beam_velocities_valid = false;
    std::array<Vector3, beams> beam_unit_vec{};
    std::array<double, beams> range{};
    std::array<float, beams> range_covar{}, beam_quality{}, beam_velocity{}, beam_velocity_covar{};

    friend bool operator==(const Dvl&, const Dvl&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"velocity_mode", "1", "over the bottom"}, self.velocity_mode);
        visit({"dvl_type", "1", "a transducer for each beam"}, self.dvl_type);
        visit({"velocity", "m/s"}, self.velocity);
        visit({"velocity_covar", "m^2/s^2", "by rows; -1: unknown"}, self.velocity_covar);
        visit({"altitude", "m"}, self.altitude);
        visit({"course_gnd", "rad", "atan2 of velocity's y and x"}, self.course_gnd);
        visit({"speed_gnd", "m/s", "of velocity's x and y"}, self.speed_gnd);
        visit({"num_good_beams", "1"}, self.num_good_beams);
        visit({"sound_speed", "m/s"}, self.sound_speed);
        visit({"beam_ranges_valid", "", "a beam has an echo"}, self.beam_ranges_valid);
        visit({"beam_velocities_valid", "", "there is bottom lock"}, self.beam_velocities_valid);
        visit({"beam_unit_vec", "1"}, self.beam_unit_vec);
        visit({"range", "m", "along each beam"}, self.range);
        visit({"range_covar", "m^2", "-1: unknown"}, self.range_covar);
        visit({"beam_quality", "1", "1: an echo, 0: none"}, self.beam_quality);
        visit({"beam_velocity", "m/s"}, self.beam_velocity);
        visit({"beam_velocity_covar", "m^2/s^2", "-1: unknown"}, self.beam_velocity_covar);
    }
};

}  // namespace insonify::ros
