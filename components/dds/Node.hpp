#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "components/ros/Options.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Describe.hpp"
#include "types/text/RosNames.hpp"
struct ddsi_sertype;

namespace insonify::dds {

/** A sample for Cyclone DDS: the bytes of one message, beginning with the encapsulation. */
using Bytes = std::vector<char>;

inline constexpr size_t any_size = std::numeric_limits<size_t>::max();

/** Returns a type with the given DDS name whose samples are Bytes, for dds_create_topic_sertype.
 *
 *  It has no key and does not announce its members, so peers match it by name alone, as in ROS 2. Otherwise a peer of a
 *  newer Cyclone that asks a process with 0.10 for the members crashes it. Bytes from the network are passed on
 *  unchecked; the receiver checks them. Messages of more than `largest` bytes are passed on empty. */
ddsi_sertype* makeRawType(const std::string& type_name, size_t maximum = any_size);

/** Owns an entity of Cyclone DDS; deletes it together with its children. */
class Entity {
public:
    Entity() = default;
    explicit Entity(int32_t handle) : handle_(handle) {}
    Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
    Entity& operator=(Entity&& other) noexcept;
    ~Entity();
    int32_t handle() const { return handle_; }

private:
    int32_t handle_ = 0;
};

/** A participant, and the domain that it needs if we have set it up. */
struct Participant {
    std::shared_ptr<Entity> domain;
    Entity entity;  ///< Leaves first.
    int32_t handle() const { return entity.handle(); }
};

/** Returns Cyclone's settings for ROS_LOCALHOST_ONLY, ROS_AUTOMATIC_DISCOVERY_RANGE and ROS_STATIC_PEERS, as
 *  rmw_cyclonedds_cpp makes them; empty if Cyclone's own fit. CYCLONEDDS_URI comes after them. Throws
 *  types::ConfigError. */
std::string discoverySettings();

/** Returns a participant of a DDS domain, with the settings of discoverySettings() and CYCLONEDDS_URI. `user_data` is
 *  announced with it. Throws types::ConfigError with Cyclone's message if the domain cannot be joined: no such network
 *  interface, an error in the settings, no free port. */
Participant joinDomain(uint32_t id, std::string_view user_data);

/** Returns `given`, else ROS_DOMAIN_ID, else 0. Throws types::ConfigError if ROS_DOMAIN_ID is not a number up to
 *  232. */
uint32_t domainId(std::optional<uint32_t> given);

/** The highest domain for which UDP has ports. */
inline constexpr uint32_t highest_domain = 232;

// The messages by which ROS 2 nodes announce themselves: rmw_dds_common, field for field. See ros/Messages.hpp.
/** Identifier of 16 bytes since ROS 2 Iron, 24 in Humble and before. */
template <size_t size>
struct Gid {
    static constexpr const char* type_name = "rmw_dds_common/msg/Gid";
    std::array<uint8_t, size> data{};

    friend bool operator==(const Gid&, const Gid&) = default;
    static void describe(auto& self, auto& visit) { visit({"data"}, self.data); }
};

template <size_t gid_size>
struct NodeEntitiesInfo {
    static constexpr const char* type_name = "rmw_dds_common/msg/NodeEntitiesInfo";
    std::string node_namespace, node_name;
    std::vector<Gid<gid_size>> reader_gid_seq, writer_gid_seq;

    friend bool operator==(const NodeEntitiesInfo&, const NodeEntitiesInfo&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"node_namespace"}, self.node_namespace);
        visit({"node_name"}, self.node_name);
        visit({"reader_gid_seq"}, self.reader_gid_seq);
        visit({"writer_gid_seq"}, self.writer_gid_seq);
    }
};

template <size_t gid_size>
struct ParticipantEntitiesInfo {
    static constexpr const char* type_name = "rmw_dds_common/msg/ParticipantEntitiesInfo";
    Gid<gid_size> gid;
    std::vector<NodeEntitiesInfo<gid_size>> node_entities_info_seq;

    friend bool operator==(const ParticipantEntitiesInfo&, const ParticipantEntitiesInfo&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"gid"}, self.gid);
        visit({"node_entities_info_seq"}, self.node_entities_info_seq);
    }
};

/** Reliability of ROS 2. A reliable reader, ROS 2's default, receives nothing from a best-effort writer. */
enum class Reliability { Reliable, BestEffort };

struct Quality {
    Reliability reliability = Reliability::Reliable;
    int depth = 5;  ///< Samples kept for slow readers, or until they are taken.
    bool transient_local = false;
    int lifespan_s = 0;  ///< After it, kept samples are dropped [s]; 0: never.
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

/** The configuration of a task's ROS 2 node. */
struct NodeConfig {
    std::string node_name;
    std::optional<uint32_t> domain;
    ros::WorldFrame world_frame = ros::WorldFrame::Enu;
    int gid_size = 16;

    static void describe(auto& self, auto& visit) {
        visit({"domain", "1", "DDS domain; absent: ROS_DOMAIN_ID, or 0", 0, highest_domain}, self.domain);
        visit({"node_name", "", "name of the ROS 2 node, /auv/sonar with a namespace; empty: the task's"},
              self.node_name);
        visit({"world_frame", "",
               "axes of poses on the wire: ours (x north, y west, z up), x east, y north, z up, or x north, y "
               "east, z down"},
              self.world_frame);
        visit({"gid_size", "B", "size of identifiers in ros_discovery_info: 16, or 24 for ROS 2 Humble and before", 16,
               24},
              self.gid_size);
    }
    void check(types::Diagnostics& diagnostics) const {
        if (gid_size != 16 && gid_size != 24)
            diagnostics.push_back({"gid_size", "is " + std::to_string(gid_size) + "; must be 16 or 24"});
        if (const std::string diagnostic = node_name.empty() ? "" : diagnosticOfNode(node_name); !diagnostic.empty())
            diagnostics.push_back({"node_name", diagnostic});
    }
    /** Returns the node's full name. @param task the task's name, used if `node_name` is empty */
    std::string nameIn(const types::RosNames& names, const std::string& task) const {
        return names.node(node_name.empty() ? task : node_name);
    }
};

/** Throws types::ConfigError with the diagnostics of a configuration whose names have been resolved for the
 *  deployment. */
void refuseWrong(const auto& named) {
    types::Diagnostics diagnostics;
    named.check(diagnostics);
    if (!diagnostics.empty()) throw types::ConfigError(diagnostics);
}

/** A ROS 2 node: a DDS participant that announces its name, readers and writers to the domain. */
class Node {
public:
    /** @param name may have a namespace: "/auv/sonar"
     *  @param gid_size 16, or 24 for Humble and before [B]
     *  Throws types::ConfigError if the domain cannot be joined. */
    Node(uint32_t domain, const std::string& name, size_t gid_size);
    ~Node();

    int32_t participant() const { return participant_.handle(); }
    Guid guid() const;
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
    Participant participant_;
    std::unique_ptr<Writer> discovery_;
    Entity publications_;  ///< Reader of the built-in topic of writers; made by the first published().
    std::vector<Guid> writers_, readers_;
};

}  // namespace insonify::dds

template <>
struct insonify::types::EnumNames<insonify::dds::Reliability> {
    static constexpr std::string_view names[] = {"reliable", "best_effort"};
};
