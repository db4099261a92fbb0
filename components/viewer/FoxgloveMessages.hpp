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
    int32_t sec = 0;
    uint32_t nanosec = 0;

    static void describe(auto& self, auto& visit) {
        visit({"sec", "s"}, self.sec);
        visit({"nanosec", "ns"}, self.nanosec);
    }
};

struct Color {
    static constexpr const char* type_name = "foxglove_msgs/msg/Color";
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
    std::vector<FrameTransform> transforms;

    static void describe(auto& self, auto& visit) { visit({"transforms"}, self.transforms); }
};

struct SceneEntityDeletion {
    static constexpr const char* type_name = "foxglove_msgs/msg/SceneEntityDeletion";
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
    std::string key;
    std::string value;

    static void describe(auto& self, auto& visit) {
        visit({"key"}, self.key);
        visit({"value"}, self.value);
    }
};

struct ArrowPrimitive {
    static constexpr const char* type_name = "foxglove_msgs/msg/ArrowPrimitive";
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
    ros::Pose pose;
    ros::Vector3 size;
    Color color;

    static void describe(auto& self, auto& visit) {
        visit({"pose"}, self.pose);
        visit({"size", "m"}, self.size);
        visit({"color"}, self.color);
    }
};

struct SpherePrimitive : CubePrimitive {
    static constexpr const char* type_name = "foxglove_msgs/msg/SpherePrimitive";
};

struct CylinderPrimitive {
    static constexpr const char* type_name = "foxglove_msgs/msg/CylinderPrimitive";
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
    std::vector<SceneEntityDeletion> deletions;
    std::vector<SceneEntity> entities;

    static void describe(auto& self, auto& visit) {
        visit({"deletions", "", "before what follows"}, self.deletions);
        visit({"entities"}, self.entities);
    }
};

}  // namespace insonify::viewer::foxglove
