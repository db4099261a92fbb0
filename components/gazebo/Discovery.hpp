#pragma once
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace insonify::gazebo {

// Datagrams by which programs of Gazebo's transport find each other: two bytes of length, least first, and a message.
// Version 10 of this protocol is spoken by ignition-transport 8 to 11 and gz-transport 12 to 15.

inline constexpr uint32_t discovery_version = 10;
/** Programs with GZ_TRANSPORT_TOPIC_STATISTICS count lost messages and speak this version. Others ignore them. */
inline constexpr uint32_t statistics_version = 110;

/** A topic or a service that a program offers. */
struct Publication {
    bool is_service = false;
    std::string topic;               ///< With its partition, see qualifiedName().
    std::string address;             ///< "tcp://192.168.1.7:40123".
    std::string process, node;       ///< UUIDs.
    std::string type;                ///< Type of its messages, or of requests: "gz.msgs.Pose_V".
    std::string reply_type, socket;  ///< Services only.
    bool is_for_host = false;        ///< Only for programs on the same machine.
};

/** What a datagram says. */
struct Announcement {
    enum class Kind { Offer, Withdrawal, Alive, Goodbye };
    Kind kind = Kind::Alive;
    std::string process;      ///< UUID of the sender.
    Publication publication;  ///< What is offered or withdrawn.
};

/** A program has gone when no datagram of it has come for this time [s]. It sends one each second. */
inline constexpr double silence_s = 3;

/** The topics and services that are there, for messages to a user whose own is not. */
class Heard {
public:
    /** Keeps the names of topics that end like this: "/pose/info". */
    explicit Heard(std::string ending) : ending_(std::move(ending)) {}
    void add(const Publication& publication);
    void addVersion(uint32_t version);
    /** "heard are /world/sea/pose/info in partition auv:me", or that there is nothing. */
    std::string text() const;

private:
    std::string ending_;
    std::set<std::string> names_;  ///< Qualified.
    std::set<uint32_t> other_versions_;
    bool is_anybody_there_ = false;
};

/** Reads a datagram. None: it is damaged, of `own_process`, of no use to a listener, or of another version, which
 *  `heard` keeps. */
std::optional<Announcement> readDatagram(std::string_view datagram, const std::string& own_process, Heard& heard);

/** Asks who offers a topic or a service. */
std::string askDatagram(const std::string& process, const std::string& topic);
std::string aliveDatagram(const std::string& process);
std::string goodbyeDatagram(const std::string& process);
/** Informs the publisher of a topic that `node` of `process` takes its messages, or no longer does. */
std::string connectionDatagram(const std::string& process, const std::string& node, const Publication& publication,
                               bool begins);

}  // namespace insonify::gazebo
