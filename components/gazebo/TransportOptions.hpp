#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace insonify::gazebo {

/** How programs of Gazebo's transport find each other on a network. */
struct TransportOptions {
    std::string partition;  ///< Programs of other partitions are not heard.
    std::string ip;         ///< The one address of this machine that is used; empty: all of them.
    std::string group = "239.255.0.7";
    uint16_t topic_port = 10317, service_port = 10318;

    /** Reads GZ_PARTITION, GZ_IP, GZ_DISCOVERY_MULTICAST_IP, GZ_DISCOVERY_MSG_PORT and GZ_DISCOVERY_SRV_PORT, or the
     *  same that begin with IGN where those are not set. A `partition` that is given takes the place of the variable;
     *  without either it is "HOST:USER". Throws types::ConfigError: the partition or a port is none. */
    static TransportOptions fromEnvironment(const std::string& partition);
};

/** A topic or a service with its partition, as programs name it to each other: "@/partition@/topic". None where the
 *  transport does not take one of both: it is empty, or has a blank, '@', '~' or "//" in it. */
std::optional<std::string> qualifiedName(const std::string& partition, const std::string& topic);

/** The parts of a qualified name; none of another text. The partition has no '/' before it. */
struct TopicName {
    std::string partition, topic;
    static std::optional<TopicName> of(const std::string& qualified);
};

/** "Pose_V" of "ignition.msgs.Pose_V" and "gz.msgs.Pose_V"; all of a type of others. */
std::string messageName(const std::string& type);

/** 36 characters that nobody else has. */
std::string makeUuid();

}  // namespace insonify::gazebo
