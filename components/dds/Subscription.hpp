#pragma once
#include <functional>
#include <string>

#include "components/dds/Endpoints.hpp"
#include "components/dds/SubscriberConfig.hpp"
#include "components/ros/GeometryMessages.hpp"
#include "types/Pose.hpp"
#include "types/ThrottledWarning.hpp"

namespace insonify::dds {

/** Decodes and checks the poses of one topic. */
class Subscription {
public:
    /** @param arrived as in Reader
     *  @param drops counts the messages that are dropped
     *  @param odd counts the poses whose quaternion is not near unit length
     *  Both counters must outlive this. */
    Subscription(Node& node, const SubscriberConfig& config, const TopicIn& topic, types::ThrottledWarning& drops,
                 types::ThrottledWarning& odd, std::function<void()> arrived);

    /** Takes the next valid pose, in Rock's axes, with an orientation of unit length. The time is `now` if the message
     *  has no stamp, or if the topic is configured so.
     *
     *  Returns false and leaves `pose` unchanged if there is none, or after 64 drops; more() then returns true. Bytes
     *  that cannot be decoded or exceed 64 KiB are dropped, and poses that are not finite or without an orientation.
     *  Stamps are dropped if they are more than a second ahead of `now` or before that of the previous pose. Earlier
     *  stamps are accepted once the sender is gone or no valid pose arrived for a second: a looped bag and a reset
     *  simulator begin anew. */
    bool take(types::Time now, types::Pose& pose);

    /** Returns why no pose arrives, from the domain's discovery: no writer, a writer of another type or quality, or
     *  writers that send nothing valid. */
    std::string absence(Node& node) const;

    /** Returns whether take() stopped before it had looked at all messages. */
    bool more() const { return more_; }

private:
    void decode(types::Pose& pose);
    /** Returns an empty text for a valid pose. */
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
    ros::Time stamp_;  ///< Stamp of the last message, with its nanoseconds.
    uint64_t sender_ = 0, newest_sender_ = 0;
    types::Time newest_, newest_came_;
    bool stamped_on_arrival_, more_ = false;
    types::ThrottledWarning &drops_, &odd_;
    Reader reader_;
};

}  // namespace insonify::dds
