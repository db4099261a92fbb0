#pragma once
// ROS 2 messages of std_msgs that hold one value: see GeometryMessages.hpp.
#include <string>

#include "components/ros/GeometryMessages.hpp"

namespace insonify::ros {

struct Bool {
    static constexpr const char* type_name = "std_msgs/msg/Bool";
    static constexpr const char* type_hash = "RIHS01_feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9";
    bool data = false;

    static void describe(auto& self, auto& visit) { visit({"data"}, self.data); }
};

struct Int32 {
    static constexpr const char* type_name = "std_msgs/msg/Int32";
    static constexpr const char* type_hash = "RIHS01_b6578ded3c58c626cfe8d1a6fb6e04f706f97e9f03d2727c9ff4e74b1cef0deb";
    int32_t data = 0;

    static void describe(auto& self, auto& visit) { visit({"data"}, self.data); }
};

struct Int64 {
    static constexpr const char* type_name = "std_msgs/msg/Int64";
    static constexpr const char* type_hash = "RIHS01_8cd1048c2f186b6bd9a92472dc1ce51723c0833a221e2b7aecfff111774f4b49";
    int64_t data = 0;

    static void describe(auto& self, auto& visit) { visit({"data"}, self.data); }
};

struct Float32 {
    static constexpr const char* type_name = "std_msgs/msg/Float32";
    static constexpr const char* type_hash = "RIHS01_7170d3d8f841f7be3172ce5f4f59f3a4d7f63b0447e8b33327601ad64d83d6e2";
    float data = 0;

    static void describe(auto& self, auto& visit) { visit({"data"}, self.data); }
};

struct Float64 {
    static constexpr const char* type_name = "std_msgs/msg/Float64";
    static constexpr const char* type_hash = "RIHS01_705ba9c3d1a09df43737eb67095534de36fd426c0587779bda2bc51fe790182a";
    double data = 0;

    static void describe(auto& self, auto& visit) { visit({"data"}, self.data); }
};

struct String {
    static constexpr const char* type_name = "std_msgs/msg/String";
    static constexpr const char* type_hash = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18";
    std::string data;

    static void describe(auto& self, auto& visit) { visit({"data"}, self.data); }
};

}  // namespace insonify::ros
