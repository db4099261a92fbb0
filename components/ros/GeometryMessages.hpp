#pragma once
// ROS 2 messages of builtin_interfaces, std_msgs, rosgraph_msgs, geometry_msgs, nav_msgs and tf2_msgs, field for field.
//
// Each message is described once (see types/Describe.hpp); its CDR bytes and its schema text follow from the
// description. `type_hash` is the RIHS01 hash of the type, as ROS 2 announces it to other nodes.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "types/Describe.hpp"

namespace insonify::ros {

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

}  // namespace insonify::ros
