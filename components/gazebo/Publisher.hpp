#pragma once
#include <memory>
#include <string>
#include <vector>

#include "components/gazebo/TransportOptions.hpp"

namespace insonify::gazebo {

/** A topic that is offered to programs of Gazebo's transport. */
struct Offer {
    std::string topic;  ///< "/rov/sonar".
    std::string type;   ///< "LaserScan", without the scope.
};

/** Offers topics, and sends their messages to the programs that read them, on its own thread until destroyed.
 *
 *  The scope of types is that of the first program that offers a topic, "ignition.msgs." for Fortress or "gz.msgs.";
 *  without such a program "gz.msgs." after three seconds. Until then nothing is offered. */
class Publisher {
public:
    static constexpr size_t max_waiting = 32;  ///< Messages that wait for the thread; beyond, the oldest is lost.

    /** Throws types::ConfigError when no network supports multicast, or a topic is invalid for the transport; `path` is
     *  then the index of the topic, such as "1". */
    Publisher(const TransportOptions& options, const std::vector<Offer>& offers);
    ~Publisher();
    Publisher(const Publisher&) = delete;
    Publisher& operator=(const Publisher&) = delete;

    /** Returns whether a program reads the topic of this index. Thread-safe. */
    bool hasReaders(size_t offer) const;
    /** Sends a message, without waiting for readers. Thread-safe. */
    void publish(size_t offer, std::string message);
    /** Returns the number of messages that were lost because more waited than max_waiting. */
    uint64_t lost() const;

private:
    class Worker;
    std::unique_ptr<Worker> worker_;
};

}  // namespace insonify::gazebo
