#pragma once
#include <memory>
#include <string>
#include <vector>

#include "components/gazebo/TransportOptions.hpp"
#include "components/ros/Messages.hpp"
#include "types/Time.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::gazebo {

/** The header of a message of Gazebo. */
struct Stamp {
    types::Time time;
    std::string frame_id;
};

// Bytes of Gazebo's messages. Throw std::invalid_argument for a sample that the message cannot represent.

/** Writes an Image: grey or colours of 8 bits, or grey of 16. */
std::string encode(const ros::Image& picture, const Stamp& stamp);
/** Writes a LaserScan: a range for each ray from starboard to port [m], infinite where there is no return. */
std::string encode(const ros::LaserScan& scan, const Stamp& stamp);
/** Writes a PointCloudPacked. */
std::string encode(const ros::PointCloud2& cloud, const Stamp& stamp);
/** Writes a Float_V: all bins of the first beam, then of the next. Its header has `beam_count` and `bin_count` [1],
 *  `bin_width` [m], `speed_of_sound` [m/s] and a list `bearings`, positive to port [rad]. */
std::string encode(const types::Sonar& ping, const Stamp& stamp);

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
