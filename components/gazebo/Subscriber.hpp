#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "components/gazebo/TransportOptions.hpp"

namespace insonify::gazebo {

/** A topic of Gazebo's transport, and what takes its messages. */
struct Topic {
    std::string name;  ///< "/world/sea/pose/info".
    /** Called on the subscriber's thread, with the name of the message's type, "Pose_V", and its bytes. */
    std::function<void(const std::string& type, std::string_view message)> use;
};

/** Receives topics of Gazebo's transport, on a thread of its own, for as long as it lives.
 *
 *  Gazebo Fortress and all later ones are understood. Publishers may come and go; one that starts again is found anew.
 *  Messages come by TCP from each publisher of the topic. */
class Subscriber {
public:
    /** Throws types::ConfigError: no network takes part, or the transport does not take a topic; `path` is then the
     *  topic's place in the list, "1". */
    Subscriber(const TransportOptions& options, std::vector<Topic> topics);
    ~Subscriber();
    Subscriber(const Subscriber&) = delete;
    Subscriber& operator=(const Subscriber&) = delete;

    /** Whether somebody publishes the topic at this place in the list. For any thread. */
    bool hasPublisher(size_t topic) const;
    /** Lists the topics that are there and end like the first of the list. For any thread. */
    std::string heard() const;

private:
    class Worker;
    std::unique_ptr<Worker> worker_;
};

}  // namespace insonify::gazebo
