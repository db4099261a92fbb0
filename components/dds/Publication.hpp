#pragma once
#include <functional>
#include <string>

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
    /** Throws types::ConfigError for a message that cannot be made of a Sample, and as Writer. */
    Publication(Node& node, const PublisherConfig& config, const TopicOut& topic);

    /** Makes no message for a topic that nobody reads. Throws std::invalid_argument for a sample that the message
     *  cannot hold (see ros/FromSonar.hpp), std::out_of_range for such a time. */
    void publish(const Sample& sample);
    bool hasReaders() const { return writer_.hasReaders(); }
    /** How many messages could not be sent, and why; empty: none. */
    std::string losses() const;

private:
    std::string topic_;
    std::function<void(const Sample&, Bytes&)> encode_;
    Writer writer_;
    Bytes bytes_;
    uint64_t lost_ = 0;
};

/** Types of messages that a Sample can be, as in YAML: "nav_msgs/Odometry, ...". */
template <class Sample>
std::string messagesOf();

}  // namespace insonify::dds
