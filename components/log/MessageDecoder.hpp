#pragma once
// ROS 2 messages of a topic as samples, for the formats that contain them.
#include <memory>
#include <span>
#include <string>

#include "components/log/Stream.hpp"
#include "types/geometry/WorldFrame.hpp"

namespace insonify::log {

/** Reads the messages of one topic as samples. */
class MessageDecoder {
public:
    virtual ~MessageDecoder() = default;
    /** Throws std::exception for invalid messages. */
    virtual void decode(std::span<const char> bytes, types::SampleRoom room) = 0;
};

/** A topic as a file declares it. */
struct DeclaredTopic {
    std::string name;           ///< "/auv/odometry"
    std::string type;           ///< "nav_msgs/msg/Odometry"; empty: unknown.
    std::string encoding;       ///< "cdr"
    const Metadata* texts;      ///< How Insonify has written its messages; not null.
    types::WorldFrame foreign;  ///< Axes of poses where the texts do not say them.
};

/** Returns the stream of a topic without its metadata: its written name, else "a.b" for "/a/b", and the type of its
 *  samples. */
Stream getStream(const DeclaredTopic& topic);

/** Returns the decoder of a topic's messages; null: they are not samples. */
std::unique_ptr<MessageDecoder> makeDecoder(const DeclaredTopic& topic);

}  // namespace insonify::log
