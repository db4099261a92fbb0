#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "types/Pose.hpp"
#include "types/Time.hpp"
#include "types/WorldFrame.hpp"

namespace insonify::gazebo {

/** The poses in a message Pose_V: a world's models and, among them, all of their links, by their names. */
struct PoseMessage {
    struct Entity {
        std::string name;
        types::Pose pose;  ///< In our axes; without a time. What the message does not have is unknown.
    };
    std::optional<types::Time> stamp;  ///< Simulated time; none: the message has none, or one that is out of bounds.
    std::vector<Entity> entities;
};
/** None: these are no bytes of a Pose_V. */
std::optional<PoseMessage> readPoses(std::string_view message, types::WorldFrame frame);

/** The pose in a message Odometry, with velocities, which the message has in the body. */
struct OdometryMessage {
    std::optional<types::Time> stamp;  ///< As above.
    types::Pose pose;                  ///< As above.
};
/** None: these are no bytes of an Odometry. */
std::optional<OdometryMessage> readOdometry(std::string_view message, types::WorldFrame frame);

/** The entity of a name. */
struct FoundEntity {
    const types::Pose* pose = nullptr;
    std::string diagnostic;  ///< Why there is none: nobody has the name, or several have.
};
FoundEntity findEntity(const PoseMessage& message, const std::string& name);

}  // namespace insonify::gazebo
