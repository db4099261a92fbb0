#pragma once
#include <functional>
#include <string>
#include <vector>

#include "components/dds/Endpoints.hpp"
#include "components/dds/SubscriberConfig.hpp"
#include "components/ros/GeometryMessages.hpp"
#include "types/Pose.hpp"
#include "types/ThrottledWarning.hpp"

namespace insonify::dds {

/** The poses of one topic, those that can be used. */
class Subscription {
public:
    /** `arrived` as in Reader. Messages that are dropped are counted in `drops`, poses whose quaternion is not near
     * unit length in `odd`; both outlive this. */
    Subscription(Node& node, const SubscriberConfig& config, const TopicIn& topic, types::ThrottledWarning& drops,
                 types::ThrottledWarning& odd, std::function<void()> arrived);

    /** The next good pose, in Rock's axes, its orientation of unit length; stamped `now` where the message has no
     *  stamp, or by the topic's choice. False, and `pose` as it was: there is none, or 64 before it had to be dropped:
     *  then more() tells. Dropped are: bytes that are no such message or are more than any is (64 KiB), poses that are
     *  not finite or without an orientation, and stamps more than a second ahead of `now` or before that of the pose
     *  before, until its sender is gone or nothing good came for a second: a bag that is played in a loop and a
     *  simulator that was reset begin anew. */
    bool take(types::Time now, types::Pose& pose);

    /** Why no pose comes, by what the domain's discovery knows: no writer, one of another type or quality, or silent
     * ones. */
    std::string absence(Node& node) const;

    /** Whether take() gave up before it had looked at all. */
    bool more() const { return more_; }

private:
    void decode(types::Pose& pose);
    /** Empty for a pose that can be used. */
    std::string diagnosticOf(types::Time now, const types::Pose& pose);

    std::string topic_;
    uint32_t domain_;
    Reliability reliability_;
    PoseType type_;
    ros::WorldFrame world_frame_;
    Bytes bytes_;
    types::Pose read_;
    ros::Odometry odometry_;
    ros::PoseStamped stamped_;
    ros::Time stamp_;  ///< Of the message that was read last, with its nanoseconds.
    uint64_t sender_ = 0, newest_sender_ = 0;
    types::Time newest_, newest_came_;
    bool stamped_on_arrival_, more_ = false;
    types::ThrottledWarning &drops_, &odd_;
    Reader reader_;
};

}  // namespace insonify::dds
