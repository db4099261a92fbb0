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
// Each message is described once (see types/text/Describe.hpp); its CDR bytes and its schema text follow from the
// description. `type_hash` is the RIHS01 hash of the type, as ROS 2 announces it to other nodes.
struct Time {
    static constexpr const char* type_name = "builtin_interfaces/msg/Time";
    static constexpr const char* type_hash = "RIHS01_b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197";
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
    static constexpr const char* type_hash = "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01";
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
    static constexpr const char* type_hash = "RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564";
    Time clock;

    friend bool operator==(const Clock&, const Clock&) = default;
    static void describe(auto& self, auto& visit) { visit({"clock", "", "simulated time"}, self.clock); }
};

struct Vector3 {
    static constexpr const char* type_name = "geometry_msgs/msg/Vector3";
    static constexpr const char* type_hash = "RIHS01_cc12fe83e4c02719f1ce8070bfd14aecd40f75a96696a67a2a1f37f7dbb0765d";
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
    static constexpr const char* type_hash = "RIHS01_6963084842a9b04494d6b2941d11444708d892da2f4b09843b9c43f42a7f6881";
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
    static constexpr const char* type_hash = "RIHS01_8a765f66778c8ff7c8ab94afcc590a2ed5325a1d9a076ffff38fbce36f458684";
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
    static constexpr const char* type_hash = "RIHS01_d501954e9476cea2996984e812054b68026ae0bfae789d9a10b23daf35cc90fa";
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
    static constexpr const char* type_hash = "RIHS01_10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8";
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
    static constexpr const char* type_hash = "RIHS01_9a7c0fd234b7f45c6098745ecccd773ca1085670e64107135397aee31c02e1bb";
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
    static constexpr const char* type_hash = "RIHS01_26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e";
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
    static constexpr const char* type_hash = "RIHS01_9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a";
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
    static constexpr const char* type_hash = "RIHS01_49f574f033f095d8b6cd1beaca5ca7925e296e84af1716d16c89d38b059c8c18";
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
    static constexpr const char* type_hash = "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0";
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
    static constexpr const char* type_hash = "RIHS01_beb83fbe698636351461f6f35d1abb20010c43d55374d81bd041f1ba2581fddc";
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
    static constexpr const char* type_hash = "RIHS01_0a241f87d04668d94099cbb5ba11691d5ad32c2f29682e4eb5653424bd275206";
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
    static constexpr const char* type_hash = "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087";
    std::vector<TransformStamped> transforms;

    friend bool operator==(const TFMessage&, const TFMessage&) = default;
    static void describe(auto& self, auto& visit) { visit({"transforms"}, self.transforms); }
};

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

struct NavSatStatus {
    static constexpr const char* type_name = "sensor_msgs/msg/NavSatStatus";
    static constexpr const char* type_hash = "RIHS01_d1ed3befa628e09571bd273b888ba1c1fd187c9a5e0006b385d7e5e9095a3204";
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
    static constexpr const char* type_hash = "RIHS01_62223ab3fe210a15976021da7afddc9e200dc9ec75231c1b6a557fc598a65404";
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
