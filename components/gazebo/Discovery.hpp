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
/** Of programs that count what topics lose (GZ_TRANSPORT_TOPIC_STATISTICS), whom others do not hear. */
inline constexpr uint32_t statistics_version = 110;

/** A topic or a service that a program offers. */
struct Publication {
    bool is_service = false;
    std::string topic;               ///< With its partition, see qualifiedName().
    std::string address;             ///< "tcp://192.168.1.7:40123".
    std::string process, node;       ///< UUIDs.
    std::string type;                ///< Of its messages, or of requests: "gz.msgs.Pose_V".
    std::string reply_type, socket;  ///< Of a service.
    bool is_for_host = false;        ///< Only for programs on the same machine.
};

/** What a datagram says. */
struct Announcement {
    enum class Kind { Offer, Withdrawal, Alive, Goodbye };
    Kind kind = Kind::Alive;
    std::string process;      ///< UUID of the sender.
    Publication publication;  ///< Of an offer or a withdrawal.
};

/** Programs of which a datagram says nothing for so long have gone [s]. They send one each second. */
inline constexpr double silence_s = 3;

/** What topics and services there are, for one who does not find his. */
class Heard {
public:
    /** Of topics, those that end so are kept: "/pose/info". */
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

/** Reads a datagram; none: it is damaged, of `own_process`, of another version, which `heard` keeps, or of no use to
 * who listens. */
std::optional<Announcement> readDatagram(std::string_view datagram, const std::string& own_process, Heard& heard);

/** Asks who offers a topic or a service. */
std::string askDatagram(const std::string& process, const std::string& topic);
std::string aliveDatagram(const std::string& process);
std::string goodbyeDatagram(const std::string& process);
/** Tells the publisher of a topic that `node` of `process` takes its messages, or no longer does. */
std::string connectionDatagram(const std::string& process, const std::string& node, const Publication& publication,
                               bool begins);

}  // namespace insonify::gazebo
