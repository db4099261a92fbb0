#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "components/gazebo/TransportOptions.hpp"

namespace insonify::gazebo {

/** A topic of Gazebo's transport, and the function that takes its messages. */
struct Topic {
    std::string name;  ///< "/world/sea/pose/info".
    /** Called on the subscriber's thread, with the name of the message's type, "Pose_V", and its bytes. */
    std::function<void(const std::string& type, std::string_view message)> use;
};

/** Receives topics of Gazebo's transport on its own thread until destroyed.
 *
 *  Supports Gazebo Fortress and all later versions. Publishers may start, stop and restart at any time. Messages arrive
 *  by TCP from each publisher of the topic. */
class Subscriber {
public:
    /** Throws types::ConfigError when no network supports multicast, or when a topic is invalid for the transport;
     *  `path` is then the index of the topic, such as "1". */
    Subscriber(const TransportOptions& options, std::vector<Topic> topics);
    ~Subscriber();
    Subscriber(const Subscriber&) = delete;
    Subscriber& operator=(const Subscriber&) = delete;

    /** Returns whether the topic of this index has a publisher. Thread-safe. */
    bool hasPublisher(size_t topic) const;
    /** Lists the available topics with the ending of the first topic. Thread-safe. */
    std::string received() const;

private:
    class Worker;
    std::unique_ptr<Worker> worker_;
};

}  // namespace insonify::gazebo
