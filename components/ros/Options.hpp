#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "types/ReturnLevels.hpp"
#include "types/geometry/WorldFrame.hpp"
#include "types/text/Describe.hpp"

namespace insonify::ros {

/** The order of an image's echoes. RangeMajor: the same bin of the next beam follows (as in sonar_image_proc and
 *  drivers). BeamMajor: the next bin of the same beam follows (as in the text of marine_acoustic_msgs). */
enum class ImageOrder { RangeMajor, BeamMajor };

/** The type of an image's numbers: levels in eight bits, or the bins unchanged. */
enum class ImageType { Uint8, Float32 };

/** The axes of a sonar's measurements: z ahead, x up, y to starboard (marine_acoustic_msgs), or x ahead, y to port, z
 *  up (Rock, REP 103). */
enum class SensorFrame { ZForward, XForward };

/** The content of a ping's bins: linear intensities, or levels in dB. */
enum class BinScale { Linear, Decibel };

using types::WorldFrame;

/** Adds a diagnostic for the path where the name of a frame is invalid in tf2. */
inline void checkFrame(const std::string& path, const std::string& name, types::Diagnostics& diagnostics) {
    const auto isVisible = [](char c) { return static_cast<unsigned char>(c) > ' ' && c != 0x7f; };
    if (name.empty() || name.front() == '/' || !std::ranges::all_of(name, isVisible))
        diagnostics.push_back({path, "is \"" + name +
                                         "\"; must be a name without spaces and without a leading slash, as sonar or "
                                         "auv/sonar"});
}

/** Options for converting pings to messages. The defaults keep the bins without loss, in logs and on the wire alike. A
 *  level is 10 log10 of a bin [dB]. */
struct SonarOptions {
    ImageOrder order = ImageOrder::RangeMajor;
    ImageType dtype = ImageType::Float32;
    SensorFrame frame = SensorFrame::ZForward;
    BinScale scale = BinScale::Linear;
    double dynamic_range_db = 60;
    std::optional<double> reference_db;
    double threshold_db = -20;
    double frequency_khz = 0;
    std::string frame_id = "sonar";
    std::optional<double> range_min;
    types::ReturnRules returns;  ///< Of the sonar whose pings are converted; not a key.

    static void describe(auto& self, auto& visit) {
        visit({"order", "", "order of an image's echoes: all beams of a bin together, or all bins of a beam"},
              self.order);
        visit({"dtype", "", "type of an image's echoes: uint8 levels, or the bins as float32"}, self.dtype);
        visit({"frame", "",
               "axes of directions in marine_acoustic_msgs: z ahead and x up, or x ahead and z up as in all of "
               "sensor_msgs"},
              self.frame);
        visit({"scale", "", "content of the bins: linear intensities, or decibel"}, self.scale);
        visit({"dynamic_range_db", "dB", "range of uint8: 255 is the reference, 0 is this far below it", 1, 300},
              self.dynamic_range_db);
        visit({"reference_db", "dB", "level of the strongest echo; absent: that of each ping", -3000, 3000},
              self.reference_db);
        visit({"threshold_db", "dB", "min level of a return, relative to the reference", -300, 0}, self.threshold_db);
        visit({"range_min", "m",
               "nearer bins are no returns; absent: the sonar's range_min, or its receiver's blanking", 0, 1e5},
              self.range_min);
        visit({"frequency_khz", "kHz", "frequency of the device; 0: that of the sonar, if known", 0, 1e5},
              self.frequency_khz);
        visit({"frame_id", "", "name of the sonar's frame"}, self.frame_id);
    }
};

/** Options for converting samples to messages and back. */
struct MessageOptions : SonarOptions {
    WorldFrame world_frame = WorldFrame::Enu;

    static void describe(auto& self, auto& visit) {
        SonarOptions::describe(self, visit);
        visit({"world_frame", "", "axes of poses: Rock's as they are, ENU or NED"}, self.world_frame);
    }
};

}  // namespace insonify::ros

template <>
struct insonify::types::EnumNames<insonify::ros::ImageOrder> {
    static constexpr std::string_view names[] = {"range_major", "beam_major"};
};
template <>
struct insonify::types::EnumNames<insonify::ros::ImageType> {
    static constexpr std::string_view names[] = {"uint8", "float32"};
};
template <>
struct insonify::types::EnumNames<insonify::ros::SensorFrame> {
    static constexpr std::string_view names[] = {"z_forward", "x_forward"};
};
template <>
struct insonify::types::EnumNames<insonify::ros::BinScale> {
    static constexpr std::string_view names[] = {"linear", "decibel"};
};
