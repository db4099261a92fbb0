#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "components/gazebo/TransportOptions.hpp"

namespace insonify::gazebo {

/** A service of Gazebo's transport, without the scope of its types: "Empty", "Scene". */
struct Service {
    std::string name;  ///< "/world/sea/scene/info".
    std::string request_type, reply_type;
};

/** The reply of a service. */
struct Reply {
    std::string message;  ///< Bytes of its type.
    std::string failure;  ///< Why there is no message, as the rest of a sentence after the service's name.
};

/** Finds a service and calls it once with a message of these bytes; waits at most `timeout`. Throws types::ConfigError
 *  when no network supports multicast, or the name is invalid for the transport. */
Reply request(const TransportOptions& options, const Service& service, const std::string& message,
              std::chrono::duration<double> timeout);

// Datagrams by which programs of Gazebo's transport find each other: two bytes of length, little endian, and a message.
// ignition-transport 8 to 11 and gz-transport 12 to 15 use version 10 of this protocol.

inline constexpr uint32_t discovery_version = 10;
/** Version of programs with GZ_TRANSPORT_TOPIC_STATISTICS, which count lost messages. Other programs ignore them. */
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

/** The content of a datagram. */
struct Announcement {
    enum class Kind { Offer, Withdrawal, Question, Alive, Goodbye };
    Kind kind = Kind::Alive;
    std::string process;      ///< UUID of the sender.
    Publication publication;  ///< The publication that is offered, withdrawn or, by its topic, searched.
};

/** A program counts as gone after this time without a datagram [s]. Programs send a datagram each second. */
inline constexpr double silence_s = 3;

/** The available topics and services, to list when the topic or service of a user is missing. */
class Received {
public:
    /** Keeps the names of topics with this ending, such as "/pose/info". */
    explicit Received(std::string ending) : ending_(std::move(ending)) {}
    void add(const Publication& publication);
    void addVersion(uint32_t version);
    /** Returns a text such as "available are /world/sea/pose/info in partition auv:me", or that nothing is
     *  available. */
    std::string text() const;

private:
    std::string ending_;
    std::set<std::string> names_;  ///< Qualified names.
    std::set<uint32_t> other_versions_;
    bool is_anybody_there_ = false;
};

/** Reads a datagram. Returns none if the datagram is damaged, of `own_process`, without use for a receiver, or of
 *  another version. `received` keeps other versions. */
std::optional<Announcement> readDatagram(std::string_view datagram, const std::string& own_process, Received& received);

/** Returns a datagram that asks for publishers of a topic or a service. */
std::string askDatagram(const std::string& process, const std::string& topic);
/** Returns a datagram that offers a topic of `publication.process`, or withdraws it. */
std::string offerDatagram(const Publication& publication, bool begins);
std::string aliveDatagram(const std::string& process);
std::string goodbyeDatagram(const std::string& process);
/** Returns a datagram that informs the publisher of a topic that `node` of `process` begins, or ends, to receive it. */
std::string connectionDatagram(const std::string& process, const std::string& node, const Publication& publication,
                               bool begins);

}  // namespace insonify::gazebo
