#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "components/dds/Reader.hpp"
#include "components/dds/SubscriberConfig.hpp"
#include "components/ros/GeometryMessages.hpp"
#include "types/Pose.hpp"

namespace insonify::dds {

/** The poses of one topic, those that can be used. */
class Subscription {
public:
    /** `arrived` as in Reader. */
    Subscription(Node& node, const SubscriberConfig& config, const TopicIn& topic, std::function<void()> arrived);

    /** The next good pose, in Rock's axes, its orientation of unit length; stamped `now` where the message has no
     *  stamp. False: there is none, or 64 before it had to be dropped. Dropped are: bytes that are no such message,
     *  poses that are not finite or without an orientation, and stamps more than a second ahead of `now` or before that
     *  of the pose before, until its sender is gone or nothing good came for a second: a bag that is played in a loop
     *  and a simulator that was reset begin anew. */
    bool take(types::Time now, types::Pose& pose);

    /** How many messages were dropped for each reason: "/auv/odometry: not finite". */
    const std::map<std::string, uint64_t>& dropped() const { return dropped_; }
    /** The reason of the last message that was dropped. */
    const std::string& lastDrop() const { return last_drop_; }

private:
    void decode(types::Pose& pose);
    /** Empty for a pose that can be used. */
    std::string faultOf(types::Time now, const types::Pose& pose);

    std::string topic_;
    PoseType type_;
    ros::WorldFrame world_frame_;
    Bytes bytes_;
    ros::Odometry odometry_;
    ros::PoseStamped stamped_;
    uint64_t sender_ = 0, newest_sender_ = 0;
    types::Time newest_, newest_came_;
    std::map<std::string, uint64_t> dropped_;
    std::string last_drop_;
    Reader reader_;
};

}  // namespace insonify::dds
