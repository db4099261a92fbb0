#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "types/Pose.hpp"
#include "types/Time.hpp"
#include "types/WorldFrame.hpp"

namespace insonify::gazebo {

/** The poses in a message Pose_V: the models of a world and all their links, by name. */
struct PoseMessage {
    struct Entity {
        std::string name;
        types::Pose pose;  ///< In our axes, without a time. Values that the message does not have are unknown.
    };
    std::optional<types::Time> stamp;  ///< Simulated time; none when the message has no stamp, or it is out of bounds.
    std::vector<Entity> entities;
};
/** Reads a Pose_V; none when the bytes are no Pose_V. */
std::optional<PoseMessage> readPoses(std::string_view message, types::WorldFrame frame);

/** The pose in a message Odometry, with velocities, which the message has in the frame of the body. */
struct OdometryMessage {
    std::optional<types::Time> stamp;  ///< As in PoseMessage.
    types::Pose pose;                  ///< As in PoseMessage::Entity.
};
/** Reads an Odometry; none when the bytes are no Odometry. */
std::optional<OdometryMessage> readOdometry(std::string_view message, types::WorldFrame frame);

/** The result of a search for an entity by name. */
struct FoundEntity {
    const types::Pose* pose = nullptr;
    std::string diagnostic;  ///< Why there is no pose: no entity, or several entities, have the name.
};
FoundEntity findEntity(const PoseMessage& message, const std::string& name);

}  // namespace insonify::gazebo
