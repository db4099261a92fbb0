#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "types/text/Describe.hpp"

namespace insonify::ros {

// ROS 2 messages of builtin_interfaces, std_msgs, rosgraph_msgs, geometry_msgs, nav_msgs, tf2_msgs and sensor_msgs,
// field for field.
//
// Each message is described once (see types/text/Describe.hpp); its CDR bytes, its schema text and the hash of its type
// follow from the description (Cdr.hpp, Schema.hpp).
struct Time {
    static constexpr const char* type_name = "builtin_interfaces/msg/Time";
    int32_t sec = 0;
    uint32_t nanosec = 0;

    friend bool operator==(const Time&, const Time&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"sec", "s", "since the epoch"}, self.sec);
        visit({"nanosec", "ns", "beyond the second, below 1e9"}, self.nanosec);
    }
};

struct Header {
    static constexpr const char* type_name = "std_msgs/msg/Header";
    Time stamp;
    std::string frame_id;

    friend bool operator==(const Header&, const Header&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"stamp", "", "when the data was true in the world"}, self.stamp);
        visit({"frame_id", "", "the frame that the data is given in"}, self.frame_id);
    }
};

struct Clock {
    static constexpr const char* type_name = "rosgraph_msgs/msg/Clock";
    Time clock;

    friend bool operator==(const Clock&, const Clock&) = default;
    static void describe(auto& self, auto& visit) { visit({"clock", "", "simulated time"}, self.clock); }
};

struct Vector3 {
    static constexpr const char* type_name = "geometry_msgs/msg/Vector3";
    double x = 0, y = 0, z = 0;

    friend bool operator==(const Vector3&, const Vector3&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"x"}, self.x);
        visit({"y"}, self.y);
        visit({"z"}, self.z);
    }
};

struct Point {
    static constexpr const char* type_name = "geometry_msgs/msg/Point";
    double x = 0, y = 0, z = 0;

    friend bool operator==(const Point&, const Point&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"x", "m"}, self.x);
        visit({"y", "m"}, self.y);
        visit({"z", "m"}, self.z);
    }
};

struct Quaternion {
    static constexpr const char* type_name = "geometry_msgs/msg/Quaternion";
    double x = 0, y = 0, z = 0, w = 1;

    friend bool operator==(const Quaternion&, const Quaternion&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"x"}, self.x);
        visit({"y"}, self.y);
        visit({"z"}, self.z);
        visit({"w"}, self.w);
    }
};

struct Pose {
    static constexpr const char* type_name = "geometry_msgs/msg/Pose";
    Point position;
    Quaternion orientation;

    friend bool operator==(const Pose&, const Pose&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"position", "m", "origin of the body in the header's frame"}, self.position);
        visit({"orientation", "1", "turns body vectors into the header's frame"}, self.orientation);
    }
};

struct PoseStamped {
    static constexpr const char* type_name = "geometry_msgs/msg/PoseStamped";
    Header header;
    Pose pose;

    friend bool operator==(const PoseStamped&, const PoseStamped&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"pose"}, self.pose);
    }
};

/** A covariance of x, y, z and the rotations about them, row by row. */
using Covariance = std::array<double, 36>;

struct PoseWithCovariance {
    static constexpr const char* type_name = "geometry_msgs/msg/PoseWithCovariance";
    Pose pose;
    Covariance covariance{};

    friend bool operator==(const PoseWithCovariance&, const PoseWithCovariance&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"pose"}, self.pose);
        visit({"covariance", "m^2, rad^2"}, self.covariance);
    }
};

struct PoseWithCovarianceStamped {
    static constexpr const char* type_name = "geometry_msgs/msg/PoseWithCovarianceStamped";
    Header header;
    PoseWithCovariance pose;

    friend bool operator==(const PoseWithCovarianceStamped&, const PoseWithCovarianceStamped&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"pose"}, self.pose);
    }
};

struct Twist {
    static constexpr const char* type_name = "geometry_msgs/msg/Twist";
    Vector3 linear;
    Vector3 angular;

    friend bool operator==(const Twist&, const Twist&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"linear", "m/s"}, self.linear);
        visit({"angular", "rad/s"}, self.angular);
    }
};

struct TwistWithCovariance {
    static constexpr const char* type_name = "geometry_msgs/msg/TwistWithCovariance";
    Twist twist;
    Covariance covariance{};

    friend bool operator==(const TwistWithCovariance&, const TwistWithCovariance&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"twist"}, self.twist);
        visit({"covariance", "m^2/s^2, rad^2/s^2"}, self.covariance);
    }
};

/** The pose is given in header.frame_id, the twist in child_frame_id: the body. */
struct Odometry {
    static constexpr const char* type_name = "nav_msgs/msg/Odometry";
    Header header;
    std::string child_frame_id;
    PoseWithCovariance pose;
    TwistWithCovariance twist;

    friend bool operator==(const Odometry&, const Odometry&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"child_frame_id", "", "the body"}, self.child_frame_id);
        visit({"pose"}, self.pose);
        visit({"twist"}, self.twist);
    }
};

struct Transform {
    static constexpr const char* type_name = "geometry_msgs/msg/Transform";
    Vector3 translation;
    Quaternion rotation;

    friend bool operator==(const Transform&, const Transform&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"translation", "m", "origin of the child in the header's frame"}, self.translation);
        visit({"rotation", "1", "turns vectors of the child into the header's frame"}, self.rotation);
    }
};

struct TransformStamped {
    static constexpr const char* type_name = "geometry_msgs/msg/TransformStamped";
    Header header;
    std::string child_frame_id;
    Transform transform;

    friend bool operator==(const TransformStamped&, const TransformStamped&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"child_frame_id"}, self.child_frame_id);
        visit({"transform"}, self.transform);
    }
};

struct TFMessage {
    static constexpr const char* type_name = "tf2_msgs/msg/TFMessage";
    std::vector<TransformStamped> transforms;

    friend bool operator==(const TFMessage&, const TFMessage&) = default;
    static void describe(auto& self, auto& visit) { visit({"transforms"}, self.transforms); }
};

struct Image {
    static constexpr const char* type_name = "sensor_msgs/msg/Image";
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

struct NavSatStatus {
    static constexpr const char* type_name = "sensor_msgs/msg/NavSatStatus";
    static constexpr const char* constants =
        "int8 STATUS_UNKNOWN=-2\nint8 STATUS_NO_FIX=-1\nint8 STATUS_FIX=0\nint8 STATUS_SBAS_FIX=1\n"
        "int8 STATUS_GBAS_FIX=2\nuint16 SERVICE_UNKNOWN=0\nuint16 SERVICE_GPS=1\nuint16 SERVICE_GLONASS=2\n"
        "uint16 SERVICE_COMPASS=4\nuint16 SERVICE_GALILEO=8\n";
    static constexpr int8_t no_fix = -1, fix = 0, sbas_fix = 1, gbas_fix = 2;
    static constexpr uint16_t gps = 1;
    int8_t status = fix;
    uint16_t service = 0;

    friend bool operator==(const NavSatStatus&, const NavSatStatus&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"status", "1", "-1: no fix"}, self.status);
        visit({"service", "1", "satellites used, as bits"}, self.service);
    }
};

/** A place on the ellipsoid of WGS 84. */
struct NavSatFix {
    static constexpr const char* type_name = "sensor_msgs/msg/NavSatFix";
    static constexpr const char* constants =
        "uint8 COVARIANCE_TYPE_UNKNOWN=0\nuint8 COVARIANCE_TYPE_APPROXIMATED=1\n"
        "uint8 COVARIANCE_TYPE_DIAGONAL_KNOWN=2\nuint8 COVARIANCE_TYPE_KNOWN=3\n";
    static constexpr uint8_t unknown = 0, diagonal_known = 2;
    Header header;
    NavSatStatus status;
    double latitude = 0, longitude = 0, altitude = 0;
    std::array<double, 9> position_covariance{};
    uint8_t position_covariance_type = 0;

    friend bool operator==(const NavSatFix&, const NavSatFix&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"status"}, self.status);
        visit({"latitude", "deg", "positive north"}, self.latitude);
        visit({"longitude", "deg", "positive east"}, self.longitude);
        visit({"altitude", "m", "above the ellipsoid; NaN: unknown"}, self.altitude);
        visit({"position_covariance", "m^2", "east, north and up, by rows"}, self.position_covariance);
        visit({"position_covariance_type", "1", "one of the constants"}, self.position_covariance_type);
    }
};

struct FluidPressure {
    static constexpr const char* type_name = "sensor_msgs/msg/FluidPressure";
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
