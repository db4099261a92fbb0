#pragma once
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "components/dds/Domain.hpp"
#include "components/dds/RawType.hpp"

namespace insonify::dds {

/** Reliability of ROS 2. A reliable reader, ROS 2's default, receives nothing from a best-effort writer. */
enum class Reliability { Reliable, BestEffort };

struct Quality {
    Reliability reliability = Reliability::Reliable;
    int depth = 5;  ///< Samples kept for slow readers, or until they are taken.
    bool transient_local = false;
};

/** Converts "/auv/sonar" or "auv/sonar" to "rt/auv/sonar". */
std::string ddsTopic(const std::string& ros_topic);
/** Converts "sensor_msgs/msg/Image" to "sensor_msgs::msg::dds_::Image_". */
std::string ddsType(std::string_view ros_type);
/** Converts "nav_msgs::msg::dds_::Odometry_" to "nav_msgs/Odometry"; returns other names unchanged. */
std::string rosType(const std::string& dds_type);
/** Returns what is wrong with the ROS name of a topic or node; empty if it is valid. */
std::string diagnosticOfTopic(const std::string& name);
std::string diagnosticOfNode(const std::string& name);

/** A writer of the domain, by its DDS names. */
struct Published {
    std::string topic, type;
};

class Writer;
using Guid = std::array<uint8_t, 16>;

/** A ROS 2 node: a DDS participant that announces its name, readers and writers to the domain. */
class Node {
public:
    /** @param name may have a namespace: "/auv/sonar"
     *  @param gid_size 16, or 24 for Humble and before [B]
     *  Throws types::ConfigError if the domain cannot be joined. */
    Node(uint32_t domain, const std::string& name, size_t gid_size);
    ~Node();

    int32_t participant() const { return participant_.handle(); }
    /** Returns a topic with the given DDS name and type; may be called several times for the same topic. See
     *  makeRawType() for `largest`. Throws types::ConfigError. */
    Entity makeTopic(const std::string& dds_topic, const std::string& dds_type, size_t maximum = any_size) const;

    /** Returns the domain's present writers, except those of this node. Takes a fraction of a millisecond. */
    std::vector<Published> published();

    void addWriter(int32_t writer);
    void addReader(int32_t reader);
    /** Publishes the node and its added readers and writers on `ros_discovery_info`. */
    void announce();

private:
    template <size_t gid_size>
    void announceWith();

    std::string namespace_, name_;
    size_t gid_size_;
    Entity participant_;
    std::unique_ptr<Writer> discovery_;
    Entity publications_;  ///< Reader of the built-in topic of writers; made by the first published().
    std::vector<Guid> writers_, readers_;
};

}  // namespace insonify::dds
