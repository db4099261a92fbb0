#pragma once
// ROS 2 messages of tf2_msgs, and what is in them: see GeometryMessages.hpp.
#include <string>
#include <vector>

#include "components/ros/GeometryMessages.hpp"

namespace insonify::ros {

struct Transform {
    static constexpr const char* type_name = "geometry_msgs/msg/Transform";
    static constexpr const char* type_hash = "RIHS01_beb83fbe698636351461f6f35d1abb20010c43d55374d81bd041f1ba2581fddc";
    Vector3 translation;
    Quaternion rotation;

    friend bool operator==(const Transform&, const Transform&) = default;
    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"translation", "m", "origin of the child in the header's frame"}, self.translation);
        visit(Field{"rotation", "1", "turns vectors of the child into the header's frame"}, self.rotation);
    }
};

struct TransformStamped {
    static constexpr const char* type_name = "geometry_msgs/msg/TransformStamped";
    static constexpr const char* type_hash = "RIHS01_0a241f87d04668d94099cbb5ba11691d5ad32c2f29682e4eb5653424bd275206";
    Header header;
    std::string child_frame_id;
    Transform transform;

    friend bool operator==(const TransformStamped&, const TransformStamped&) = default;
    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"header"}, self.header);
        visit(Field{"child_frame_id"}, self.child_frame_id);
        visit(Field{"transform"}, self.transform);
    }
};

struct TFMessage {
    static constexpr const char* type_name = "tf2_msgs/msg/TFMessage";
    static constexpr const char* type_hash = "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087";
    std::vector<TransformStamped> transforms;

    friend bool operator==(const TFMessage&, const TFMessage&) = default;
    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"transforms"}, self.transforms);
    }
};

}  // namespace insonify::ros
