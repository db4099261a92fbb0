#pragma once
// ROS 2 messages of sensor_msgs, field for field: see GeometryMessages.hpp.
#include <array>
#include <vector>

#include "components/ros/GeometryMessages.hpp"

namespace insonify::ros {

struct Image {
    static constexpr const char* type_name = "sensor_msgs/msg/Image";
    static constexpr const char* type_hash = "RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47";
    Header header;
    uint32_t height = 0, width = 0;
    std::string encoding;
    uint8_t is_bigendian = 0;
    uint32_t step = 0;
    std::vector<uint8_t> data;

    friend bool operator==(const Image&, const Image&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"height", "1", "rows"}, self.height);
        visit({"width", "1", "pixels in a row"}, self.width);
        visit({"encoding", "", "mono8, mono16, rgb8, bgr8"}, self.encoding);
        visit({"is_bigendian"}, self.is_bigendian);
        visit({"step", "B", "size of a row"}, self.step);
        visit({"data", "1", "rows from top to bottom"}, self.data);
    }
};

struct LaserScan {
    static constexpr const char* type_name = "sensor_msgs/msg/LaserScan";
    static constexpr const char* type_hash = "RIHS01_64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828";
    Header header;
    float angle_min = 0, angle_max = 0, angle_increment = 0;
    float time_increment = 0, scan_time = 0;
    float range_min = 0, range_max = 0;
    std::vector<float> ranges;
    std::vector<float> intensities;

    friend bool operator==(const LaserScan&, const LaserScan&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"angle_min", "rad", "of the first ray, positive to port"}, self.angle_min);
        visit({"angle_max", "rad", "of the last ray"}, self.angle_max);
        visit({"angle_increment", "rad"}, self.angle_increment);
        visit({"time_increment", "s", "from one ray to the next"}, self.time_increment);
        visit({"scan_time", "s", "from one scan to the next"}, self.scan_time);
        visit({"range_min", "m"}, self.range_min);
        visit({"range_max", "m"}, self.range_max);
        visit({"ranges", "m", "infinity: no return"}, self.ranges);
        visit({"intensities", "1"}, self.intensities);
    }
};

struct PointField {
    static constexpr const char* type_name = "sensor_msgs/msg/PointField";
    static constexpr const char* type_hash = "RIHS01_5c6a4750728c2bcfbbf7037225b20b02d4429634732146b742dee1726637ef01";
    static constexpr const char* constants =
        "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\nuint8 FLOAT32=7\n"
        "uint8 FLOAT64=8\n";
    static constexpr uint8_t float32 = 7, float64 = 8;
    std::string name;
    uint32_t offset = 0;
    uint8_t datatype = 0;
    uint32_t count = 0;

    friend bool operator==(const PointField&, const PointField&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"name"}, self.name);
        visit({"offset", "B", "from the start of a point"}, self.offset);
        visit({"datatype", "1", "one of the constants"}, self.datatype);
        visit({"count", "1", "elements"}, self.count);
    }
};

struct PointCloud2 {
    static constexpr const char* type_name = "sensor_msgs/msg/PointCloud2";
    static constexpr const char* type_hash = "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5";
    Header header;
    uint32_t height = 1, width = 0;
    std::vector<PointField> fields;
    bool is_bigendian = false;
    uint32_t point_step = 0, row_step = 0;
    std::vector<uint8_t> data;
    bool is_dense = true;

    friend bool operator==(const PointCloud2&, const PointCloud2&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"height", "1", "1: the points have no order"}, self.height);
        visit({"width", "1", "points in a row"}, self.width);
        visit({"fields", "", "what a point holds"}, self.fields);
        visit({"is_bigendian"}, self.is_bigendian);
        visit({"point_step", "B"}, self.point_step);
        visit({"row_step", "B"}, self.row_step);
        visit({"data"}, self.data);
        visit({"is_dense", "", "no point is invalid"}, self.is_dense);
    }
};

/** As in ROS 2 Iron and later. Humble's lacks the variance and can read the rest. */
struct Range {
    static constexpr const char* type_name = "sensor_msgs/msg/Range";
    static constexpr const char* type_hash = "RIHS01_b42b62562e93cbfe9d42b82fe5994dfa3d63d7d5c90a317981703f7388adff3a";
    static constexpr const char* constants = "uint8 ULTRASOUND=0\nuint8 INFRARED=1\n";
    static constexpr uint8_t ultrasound = 0;
    Header header;
    uint8_t radiation_type = ultrasound;
    float field_of_view = 0;
    float min_range = 0, max_range = 0;
    float range = 0;
    float variance = 0;

    friend bool operator==(const Range&, const Range&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"radiation_type", "1", "sound"}, self.radiation_type);
        visit({"field_of_view", "rad"}, self.field_of_view);
        visit({"min_range", "m"}, self.min_range);
        visit({"max_range", "m"}, self.max_range);
        visit({"range", "m", "infinity: no return"}, self.range);
        visit({"variance", "m^2", "0: unknown"}, self.variance);
    }
};

/** Covariances by rows. A first element of -1 marks a value that is not measured; zeros are an unknown covariance. */
struct Imu {
    static constexpr const char* type_name = "sensor_msgs/msg/Imu";
    static constexpr const char* type_hash = "RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b";
    Header header;
    Quaternion orientation;
    std::array<double, 9> orientation_covariance{};
    Vector3 angular_velocity;
    std::array<double, 9> angular_velocity_covariance{};
    Vector3 linear_acceleration;
    std::array<double, 9> linear_acceleration_covariance{};

    friend bool operator==(const Imu&, const Imu&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"orientation", "1", "turns the unit's vectors into the world"}, self.orientation);
        visit({"orientation_covariance", "rad^2"}, self.orientation_covariance);
        visit({"angular_velocity", "rad/s", "in the unit"}, self.angular_velocity);
        visit({"angular_velocity_covariance", "rad^2/s^2"}, self.angular_velocity_covariance);
        visit({"linear_acceleration", "m/s^2", "specific force, in the unit"}, self.linear_acceleration);
        visit({"linear_acceleration_covariance", "m^2/s^4"}, self.linear_acceleration_covariance);
    }
};

struct FluidPressure {
    static constexpr const char* type_name = "sensor_msgs/msg/FluidPressure";
    static constexpr const char* type_hash = "RIHS01_22dfb2b145a0bd5a31a1ac3882a1b32148b51d9b2f3bab250290d66f3595bc32";
    Header header;
    double fluid_pressure = 0;
    double variance = 0;

    friend bool operator==(const FluidPressure&, const FluidPressure&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"fluid_pressure", "Pa", "absolute"}, self.fluid_pressure);
        visit({"variance", "Pa^2", "0: unknown"}, self.variance);
    }
};

}  // namespace insonify::ros
