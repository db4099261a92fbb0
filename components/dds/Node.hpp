#pragma once
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "components/dds/Domain.hpp"
#include "components/dds/RawType.hpp"

namespace insonify::dds {

/** As in ROS 2. A best-effort writer is not heard by reliable readers, which ROS 2 makes by default. */
enum class Reliability { Reliable, BestEffort };

struct Quality {
    Reliability reliability = Reliability::Reliable;
    int depth = 5;  ///< Samples that are kept for readers that are behind, or for who takes them.
    bool transient_local = false;
};

/** "rt/auv/sonar" of "/auv/sonar" or "auv/sonar". */
std::string ddsTopic(const std::string& ros_topic);
/** "sensor_msgs::msg::dds_::Image_" of "sensor_msgs/msg/Image". */
std::string ddsType(std::string_view ros_type);
/** "nav_msgs/Odometry" of "nav_msgs::msg::dds_::Odometry_"; other names as they are. */
std::string rosType(const std::string& dds_type);
/** What is wrong with a ROS name of a topic or node, or nothing. */
std::string diagnosticOfTopic(const std::string& name);
std::string diagnosticOfNode(const std::string& name);

/** A writer of the domain, by its DDS names. */
struct Published {
    std::string topic, type;
};

class Writer;
using Guid = std::array<uint8_t, 16>;

/** A ROS 2 node: a participant of a domain that tells others its name and what it reads and writes. */
class Node {
public:
    /** `name` may have a namespace: "/auv/sonar". `gid_size` is 16, or 24 for Humble and before [B]. Throws
     * types::ConfigError where the domain cannot be joined.
     */
    Node(uint32_t domain, const std::string& name, size_t gid_size);
    ~Node();

    int32_t participant() const { return participant_.handle(); }
    /** A topic of that DDS name and type; several may be asked for. The rest is as in makeRawType(). Throws
     *  types::ConfigError. */
    Entity makeTopic(const std::string& dds_topic, const std::string& dds_type, size_t largest = any_size) const;

    /** The writers that the domain has at this time, without those of this node. Takes a fraction of a millisecond. */
    std::vector<Published> published();

    void addWriter(int32_t writer);
    void addReader(int32_t reader);
    /** Tells the node and what has been added to it on `ros_discovery_info`. */
    void announce();

private:
    template <size_t gid_size>
    void announceWith();

    std::string namespace_, name_;
    size_t gid_size_;
    Entity participant_;
    std::unique_ptr<Writer> discovery_;
    Entity publications_;  ///< Reads of writers, once somebody has asked for them.
    std::vector<Guid> writers_, readers_;
};

}  // namespace insonify::dds
