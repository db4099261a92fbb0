#pragma once
#include <ignition/msgs/odometry.pb.h>
#include <ignition/msgs/pose_v.pb.h>

#include <optional>
#include <string>

#include "types/Pose.hpp"
#include "types/WorldFrame.hpp"

namespace insonify::gazebo {

/** In our axes. What the message does not tell is unknown; the time stays 0. */
types::Pose poseOf(const ignition::msgs::Pose& message, types::WorldFrame frame);
/** With the velocities, which the message has in the body. */
types::Pose poseOf(const ignition::msgs::Odometry& message, types::WorldFrame frame);

/** Time of the simulation; none: the message has no stamp, or one that is out of bounds. */
std::optional<types::Time> stampOf(bool has_header, const ignition::msgs::Header& header);

struct Entity {
    const ignition::msgs::Pose* pose = nullptr;
    std::string diagnostic;  ///< Why there is none: nobody has the name, or several have.
};
/** The entity of that name. */
Entity findEntity(const ignition::msgs::Pose_V& message, const std::string& name);

}  // namespace insonify::gazebo
