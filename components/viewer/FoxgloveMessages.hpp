#pragma once
// Messages of foxglove_msgs that Foxglove's 3-D panel draws, field for field as in its ROS 2 schemas: see
// components/ros/Messages.hpp.
#include <cstdint>
#include <string>
#include <vector>

#include "components/ros/Messages.hpp"

namespace insonify::viewer::foxglove {

/** Seconds and nanoseconds. */
struct Duration {
    static constexpr const char* type_name = "builtin_interfaces/msg/Duration";
    static constexpr const char* type_hash = "RIHS01_e8d009f659816f758b75334ee1a9ca5b5c0b859843261f14c7f937349599d93b";
    int32_t sec = 0;
    uint32_t nanosec = 0;

    static void describe(auto& self, auto& visit) {
        visit({"sec", "s"}, self.sec);
        visit({"nanosec", "ns"}, self.nanosec);
    }
};

struct Color {
    static constexpr const char* type_name = "foxglove_msgs/msg/Color";
    static constexpr const char* type_hash = "RIHS01_ed1b16da40c954e6456b950c2ef4559c179e5cb98f1363cb28c3b90c6ee14120";
    double r = 0;
    double g = 0;
    double b = 0;
    double a = 1;

    static void describe(auto& self, auto& visit) {
        visit({"r", "1", "0 to 1"}, self.r);
        visit({"g", "1"}, self.g);
        visit({"b", "1"}, self.b);
        visit({"a", "1", "1: opaque"}, self.a);
    }
};

/** The pose of a frame in another. */
struct FrameTransform {
    static constexpr const char* type_name = "foxglove_msgs/msg/FrameTransform";
    static constexpr const char* type_hash = "RIHS01_55c9e596be1c38e5fa762aa6064bbf23463ecb2266231baadbd5ae0b95eba360";
    ros::Time timestamp;
    std::string parent_frame_id;
    std::string child_frame_id;
    ros::Vector3 translation;
    ros::Quaternion rotation;

    static void describe(auto& self, auto& visit) {
        visit({"timestamp"}, self.timestamp);
        visit({"parent_frame_id"}, self.parent_frame_id);
        visit({"child_frame_id"}, self.child_frame_id);
        visit({"translation", "m", "of the child's origin in the parent"}, self.translation);
        visit({"rotation", "1", "turns vectors of the child into the parent"}, self.rotation);
    }
};

struct FrameTransforms {
    static constexpr const char* type_name = "foxglove_msgs/msg/FrameTransforms";
    static constexpr const char* type_hash = "RIHS01_315904b719ab379b8e3bc70505f544519c1df6e7daf394be91891cd73e165086";
    std::vector<FrameTransform> transforms;

    static void describe(auto& self, auto& visit) { visit({"transforms"}, self.transforms); }
};

struct SceneEntityDeletion {
    static constexpr const char* type_name = "foxglove_msgs/msg/SceneEntityDeletion";
    static constexpr const char* type_hash = "RIHS01_f63f376cd92b125a4d3cf0e7a526da44c584e09caa82dde6a6a76835f166d0fd";
    static constexpr const char* constants = "uint8 MATCHING_ID=0\nuint8 ALL=1\n";
    static constexpr uint8_t matching_id = 0;
    static constexpr uint8_t all = 1;
    ros::Time timestamp;
    uint8_t type = 0;
    std::string id;

    static void describe(auto& self, auto& visit) {
        visit({"timestamp", "", "entities that are older"}, self.timestamp);
        visit({"type", "1", "one of the constants"}, self.type);
        visit({"id"}, self.id);
    }
};

struct KeyValuePair {
    static constexpr const char* type_name = "foxglove_msgs/msg/KeyValuePair";
    static constexpr const char* type_hash = "RIHS01_3a1aafc9b6c5876181434af49e3077c3e63174d48c4be9fbc8f65547c59aaded";
    std::string key;
    std::string value;

    static void describe(auto& self, auto& visit) {
        visit({"key"}, self.key);
        visit({"value"}, self.value);
    }
};

struct ArrowPrimitive {
    static constexpr const char* type_name = "foxglove_msgs/msg/ArrowPrimitive";
    static constexpr const char* type_hash = "RIHS01_717704415387f429771591ac5a0bdd8206f2ba52a39d74326da8b84bab17f5f2";
    ros::Pose pose;
    double shaft_length = 0;
    double shaft_diameter = 0;
    double head_length = 0;
    double head_diameter = 0;
    Color color;

    static void describe(auto& self, auto& visit) {
        visit({"pose"}, self.pose);
        visit({"shaft_length", "m"}, self.shaft_length);
        visit({"shaft_diameter", "m"}, self.shaft_diameter);
        visit({"head_length", "m"}, self.head_length);
        visit({"head_diameter", "m"}, self.head_diameter);
        visit({"color"}, self.color);
    }
};

struct CubePrimitive {
    static constexpr const char* type_name = "foxglove_msgs/msg/CubePrimitive";
    static constexpr const char* type_hash = "RIHS01_06bf6711c434cb4ffa573a1d18c16e27602d5eef37f7890ff96e4708c8e56c8e";
    ros::Pose pose;
    ros::Vector3 size;
    Color color;

    static void describe(auto& self, auto& visit) {
        visit({"pose"}, self.pose);
        visit({"size", "m"}, self.size);
        visit({"color"}, self.color);
    }
};

struct SpherePrimitive {
    static constexpr const char* type_name = "foxglove_msgs/msg/SpherePrimitive";
    static constexpr const char* type_hash = "RIHS01_5f892e7dffc17eff7869f98c5a218b071dcfc2557d9958d2ac6d7c8d8d692e9f";
    ros::Pose pose;
    ros::Vector3 size;
    Color color;

    static void describe(auto& self, auto& visit) {
        visit({"pose"}, self.pose);
        visit({"size", "m"}, self.size);
        visit({"color"}, self.color);
    }
};

struct CylinderPrimitive {
    static constexpr const char* type_name = "foxglove_msgs/msg/CylinderPrimitive";
    static constexpr const char* type_hash = "RIHS01_fd6ff344d48b607df2a56a12caa191842811b11ea109e2b9a8ae98bbee874e5f";
    ros::Pose pose;
    ros::Vector3 size;
    double bottom_scale = 0;
    double top_scale = 0;
    Color color;

    static void describe(auto& self, auto& visit) {
        visit({"pose"}, self.pose);
        visit({"size", "m"}, self.size);
        visit({"bottom_scale", "1"}, self.bottom_scale);
        visit({"top_scale", "1"}, self.top_scale);
        visit({"color"}, self.color);
    }
};

struct LinePrimitive {
    static constexpr const char* type_name = "foxglove_msgs/msg/LinePrimitive";
    static constexpr const char* type_hash = "RIHS01_bf0f7edfac00dec237d721b5cf5f33e61dbe1dfcf757f83c3a3aad2e03bddd58";
    static constexpr const char* constants = "uint8 LINE_STRIP=0\nuint8 LINE_LOOP=1\nuint8 LINE_LIST=2\n";
    static constexpr uint8_t line_strip = 0;
    static constexpr uint8_t line_loop = 1;
    static constexpr uint8_t line_list = 2;
    uint8_t type = 0;
    ros::Pose pose;
    double thickness = 0;
    bool scale_invariant = false;
    std::vector<ros::Point> points;
    Color color;
    std::vector<Color> colors;
    std::vector<uint32_t> indices;

    static void describe(auto& self, auto& visit) {
        visit({"type", "1", "one of the constants"}, self.type);
        visit({"pose"}, self.pose);
        visit({"thickness", "m"}, self.thickness);
        visit({"scale_invariant"}, self.scale_invariant);
        visit({"points", "m"}, self.points);
        visit({"color"}, self.color);
        visit({"colors"}, self.colors);
        visit({"indices", "1"}, self.indices);
    }
};

/** Every three indices of points make a triangle. */
struct TriangleListPrimitive {
    static constexpr const char* type_name = "foxglove_msgs/msg/TriangleListPrimitive";
    static constexpr const char* type_hash = "RIHS01_59e14f63f22ab10a4a19f48817ed4a7e1b929b0991c6774c824943b1f881de63";
    ros::Pose pose;
    std::vector<ros::Point> points;
    Color color;
    std::vector<Color> colors;
    std::vector<uint32_t> indices;

    static void describe(auto& self, auto& visit) {
        visit({"pose"}, self.pose);
        visit({"points", "m"}, self.points);
        visit({"color", "", "of all where `colors` is empty"}, self.color);
        visit({"colors"}, self.colors);
        visit({"indices", "1"}, self.indices);
    }
};

struct TextPrimitive {
    static constexpr const char* type_name = "foxglove_msgs/msg/TextPrimitive";
    static constexpr const char* type_hash = "RIHS01_e32924ba3e4ce5d7766d45b25ddd22c5186174f039ff2ff7dc0889dea8efcfe9";
    ros::Pose pose;
    bool billboard = false;
    double font_size = 0;
    bool scale_invariant = false;
    Color color;
    std::string text;

    static void describe(auto& self, auto& visit) {
        visit({"pose"}, self.pose);
        visit({"billboard"}, self.billboard);
        visit({"font_size", "m"}, self.font_size);
        visit({"scale_invariant"}, self.scale_invariant);
        visit({"color"}, self.color);
        visit({"text"}, self.text);
    }
};

struct ModelPrimitive {
    static constexpr const char* type_name = "foxglove_msgs/msg/ModelPrimitive";
    static constexpr const char* type_hash = "RIHS01_f0d3367b5bcc91d97924539cfa6a736a399f3503147041cdd0e9a10da6b47680";
    ros::Pose pose;
    ros::Vector3 scale;
    Color color;
    bool override_color = false;
    std::string url;
    std::string media_type;
    std::vector<uint8_t> data;

    static void describe(auto& self, auto& visit) {
        visit({"pose"}, self.pose);
        visit({"scale", "1"}, self.scale);
        visit({"color"}, self.color);
        visit({"override_color"}, self.override_color);
        visit({"url"}, self.url);
        visit({"media_type"}, self.media_type);
        visit({"data"}, self.data);
    }
};

/** Replaces an older entity with its id. */
struct SceneEntity {
    static constexpr const char* type_name = "foxglove_msgs/msg/SceneEntity";
    static constexpr const char* type_hash = "RIHS01_2bef8cc577d3b5cafc057812811866685a9fb926f0c18b321a8943944584863b";
    ros::Time timestamp;
    std::string frame_id;
    std::string id;
    Duration lifetime;
    bool frame_locked = false;
    std::vector<KeyValuePair> metadata;
    std::vector<ArrowPrimitive> arrows;
    std::vector<CubePrimitive> cubes;
    std::vector<SpherePrimitive> spheres;
    std::vector<CylinderPrimitive> cylinders;
    std::vector<LinePrimitive> lines;
    std::vector<TriangleListPrimitive> triangles;
    std::vector<TextPrimitive> texts;
    std::vector<ModelPrimitive> models;

    static void describe(auto& self, auto& visit) {
        visit({"timestamp"}, self.timestamp);
        visit({"frame_id"}, self.frame_id);
        visit({"id"}, self.id);
        visit({"lifetime", "", "0: until it is replaced"}, self.lifetime);
        visit({"frame_locked"}, self.frame_locked);
        visit({"metadata"}, self.metadata);
        visit({"arrows"}, self.arrows);
        visit({"cubes"}, self.cubes);
        visit({"spheres"}, self.spheres);
        visit({"cylinders"}, self.cylinders);
        visit({"lines"}, self.lines);
        visit({"triangles"}, self.triangles);
        visit({"texts"}, self.texts);
        visit({"models"}, self.models);
    }
};

struct SceneUpdate {
    static constexpr const char* type_name = "foxglove_msgs/msg/SceneUpdate";
    static constexpr const char* type_hash = "RIHS01_48c640ae3c3c25188e497ddea0ea11c2e189b50db3ef425f2c518d2355e5ff60";
    std::vector<SceneEntityDeletion> deletions;
    std::vector<SceneEntity> entities;

    static void describe(auto& self, auto& visit) {
        visit({"deletions", "", "before what follows"}, self.deletions);
        visit({"entities"}, self.entities);
    }
};

}  // namespace insonify::viewer::foxglove
