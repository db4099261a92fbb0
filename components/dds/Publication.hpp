#pragma once
#include <functional>
#include <string>

#include "components/dds/Drops.hpp"
#include "components/dds/PublisherConfig.hpp"
#include "components/dds/Writer.hpp"
#include "types/Image.hpp"
#include "types/Pose.hpp"
#include "types/Sonar.hpp"

namespace insonify::dds {

/** Sends samples as the messages of one topic. `Sample` is types::Sonar, Pose or Image. */
template <class Sample>
class Publication {
public:
    /** What is not sent is counted in `drops`, which outlives this. Throws types::ConfigError for a message that cannot
     *  be made of a Sample, and as Writer. */
    Publication(Node& node, const PublisherConfig& config, const TopicOut& topic, Drops& drops);

    /** Makes no message for a topic that nobody reads. A sample that the message cannot hold (see ros/FromSonar.hpp) is
     *  dropped. Whether it was sent. */
    bool publish(const Sample& sample);

private:
    std::string topic_;
    std::function<void(const Sample&, Bytes&)> encode_;
    Writer writer_;
    Bytes bytes_;
    Drops& drops_;
};

template <class Sample>
bool canBe(MessageType type);
/** Types of messages that a Sample can be, as in YAML: "nav_msgs/Odometry, ...". */
template <class Sample>
std::string messagesOf();

}  // namespace insonify::dds
