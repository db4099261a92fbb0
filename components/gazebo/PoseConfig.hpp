#pragma once
#include <string>
#include <vector>

#include "types/ConfigError.hpp"
#include "types/Describe.hpp"
#include "types/WorldFrame.hpp"

namespace insonify::gazebo {

/** The source of the poses of one output port. */
struct BodyConfig {
    std::string port = "pose";
    std::string entity;
    std::string odometry;

    static void describe(auto& self, auto& visit) {
        visit({"port", "", "output port of the poses"}, self.port);
        visit({"entity", "", "the model of this name, of the world's poses; empty: odometry is given"}, self.entity);
        visit({"odometry", "", "topic of the body's Odometry, /model/rov/odometry; empty: entity is given"},
              self.odometry);
    }
};

struct PoseConfig {
    std::string world;
    std::string pose_topic;
    std::vector<BodyConfig> bodies;
    types::WorldFrame world_frame = types::WorldFrame::AsIs;
    std::string partition;

    PoseConfig();  // not inline: g++ 12 would warn that its strings are uninitialized

    static void describe(auto& self, auto& visit) {
        visit({"bodies", "", "bodies whose poses are read"}, self.bodies);
        visit({"world", "", "name of Gazebo's world, whose poses are on /world/NAME/pose/info"}, self.world);
        visit({"pose_topic", "", "another topic of poses; empty: that of the world"}, self.pose_topic);
        visit({"world_frame", "",
               "axes of Gazebo's world: as_is, those of the scene, as when both read the same SDF file; enu or "
               "ned, if x of the scene is north"},
              self.world_frame);
        visit({"partition", "", "of Gazebo's transport; empty: GZ_PARTITION, or IGN_PARTITION"}, self.partition);
    }
    void check(types::Diagnostics& diagnostics) const;
    /** Returns the topic of the entities' poses. */
    std::string poseTopic() const { return pose_topic.empty() ? "/world/" + world + "/pose/info" : pose_topic; }
};

}  // namespace insonify::gazebo
