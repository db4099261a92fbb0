#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace insonify::gazebo {

/** Options by which programs of Gazebo's transport find each other on a network. */
struct TransportOptions {
    std::string partition;  ///< Programs of other partitions are ignored.
    std::string ip;         ///< The only address of this machine to use; empty: all addresses.
    std::string group = "239.255.0.7";
    uint16_t topic_port = 10317, service_port = 10318;

    /** Reads GZ_PARTITION, GZ_IP, GZ_DISCOVERY_MULTICAST_IP, GZ_DISCOVERY_MSG_PORT and GZ_DISCOVERY_SRV_PORT, or the
     *  variables with IGN instead of GZ where these are not set. A given `partition` replaces the variable; without
     *  either it is "HOST:USER". Throws types::ConfigError when the partition or a port is invalid. */
    static TransportOptions fromEnvironment(const std::string& partition);
};

/** Returns a topic or a service with its partition, as programs name it to each other: "@/partition@/topic". Returns
 *  none when either is invalid for the transport: the topic is empty, or a name contains a blank, '@', '~' or "//". */
std::optional<std::string> qualifiedName(const std::string& partition, const std::string& topic);

/** The parts of a qualified name. The partition has no leading '/'. of() returns none for other texts. */
struct TopicName {
    std::string partition, topic;
    static std::optional<TopicName> of(const std::string& qualified);
};

/** Returns "Pose_V" for "ignition.msgs.Pose_V" and "gz.msgs.Pose_V"; other types unchanged. */
std::string messageName(const std::string& type);

/** Returns a random UUID of 36 characters. */
std::string makeUuid();

}  // namespace insonify::gazebo
