#pragma once
// Messages of our own, for what ROS 2 has none: what a sonar's pings show. See GeometryMessages.hpp.
#include <string>
#include <vector>

#include "components/ros/GeometryMessages.hpp"

namespace insonify::ros {

/** Lists of numbers are beam-first: that of bin k of beam b stands at b * bin_count + k. */
struct SonarTruth {
    static constexpr const char* type_name = "insonify_msgs/msg/SonarTruth";
    static constexpr const char* type_hash = "RIHS01_82a4e12b239a23aa77bc5f78474dcd49c5fb906d7be1576282b6c1400131ecc5";
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
    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"header"}, self.header);
        visit(Field{"bin_duration_us", "us", "one-way travel time through one bin"}, self.bin_duration_us);
        visit(Field{"sound_speed", "m/s"}, self.sound_speed);
        visit(Field{"bin_count", "1", "bins per beam"}, self.bin_count);
        visit(Field{"bearings", "rad", "of each beam, positive to port"}, self.bearings);
        visit(Field{"objects", "", "names of all objects"}, self.objects);
        visit(Field{"elevation", "rad", "positive up"}, self.elevation);
        visit(Field{"object", "1", "index into `objects`; -1: none"}, self.object);
        visit(Field{"share", "1", "of that object in the energy"}, self.share);
        visit(Field{"hits", "1", "samples"}, self.hits);
        visit(Field{"grazing", "rad"}, self.grazing);
        visit(Field{"path", "1", "0: direct"}, self.path);
        visit(Field{"shadow", "", "1: nothing heard though nearer than the last echo"}, self.shadow);
    }
};

/** A number for each beam; NaN: there is none. */
struct SonarReturns {
    static constexpr const char* type_name = "insonify_msgs/msg/SonarReturns";
    static constexpr const char* type_hash = "RIHS01_886f7d15e37c56383d9cf3ff5d14971d9f7b1f4966719de81bed57380e1a6c41";
    Header header;
    std::vector<double> bearings;
    std::vector<float> first_range;
    std::vector<float> first_level;
    std::vector<float> first_elevation;
    std::vector<float> strongest_range;
    std::vector<float> strongest_level;
    std::vector<float> strongest_elevation;

    friend bool operator==(const SonarReturns&, const SonarReturns&) = default;
    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"header"}, self.header);
        visit(Field{"bearings", "rad", "of each beam, positive to port"}, self.bearings);
        visit(Field{"first_range", "m"}, self.first_range);
        visit(Field{"first_level", "dB"}, self.first_level);
        visit(Field{"first_elevation", "rad"}, self.first_elevation);
        visit(Field{"strongest_range", "m"}, self.strongest_range);
        visit(Field{"strongest_level", "dB"}, self.strongest_level);
        visit(Field{"strongest_elevation", "rad"}, self.strongest_elevation);
    }
};

}  // namespace insonify::ros
