#include "components/gazebo/Discovery.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gazebo_messages.pb.h>  // made by the build, of messages.proto

#include <vector>

#include "components/gazebo/TransportOptions.hpp"

namespace insonify::gazebo {
namespace {

constexpr size_t max_received = 100, max_versions = 3;

std::string framed(const wire::Discovery& message) {
    std::string datagram(2, '\0');
    message.AppendToString(&datagram);
    const size_t size = datagram.size() - 2;
    datagram[0] = static_cast<char>(size & 0xff);
    datagram[1] = static_cast<char>(size >> 8);
    return datagram;
}

wire::Discovery messageOf(const std::string& process, wire::Discovery::Type type) {
    wire::Discovery message;
    message.set_version(discovery_version);
    message.set_process_uuid(process);
    message.set_type(type);
    return message;
}

std::optional<Announcement::Kind> kindOf(wire::Discovery::Type type) {
    switch (type) {
        case wire::Discovery::ADVERTISE: return Announcement::Kind::Offer;
        case wire::Discovery::UNADVERTISE: return Announcement::Kind::Withdrawal;
        case wire::Discovery::BYE: return Announcement::Kind::Goodbye;
        case wire::Discovery::HEARTBEAT: return Announcement::Kind::Alive;
        default: return {};
    }
}

Publication publicationOf(const wire::Discovery::Publisher& message) {
    Publication publication;
    publication.is_service = message.has_srv_pub();
    publication.topic = message.topic();
    publication.address = message.address();
    publication.process = message.process_uuid();
    publication.node = message.node_uuid();
    publication.type = publication.is_service ? message.srv_pub().request_type() : message.msg_pub().msg_type();
    publication.reply_type = message.srv_pub().response_type();
    publication.socket = message.srv_pub().socket_id();
    publication.is_for_host = message.scope() == wire::Discovery::Publisher::HOST;
    return publication;
}

}  // namespace

void Received::add(const Publication& publication) {
    is_anybody_there_ = true;
    if (publication.topic.ends_with(ending_) && names_.size() < max_received) names_.insert(publication.topic);
}

void Received::addVersion(uint32_t version) {
    if (version == discovery_version)
        is_anybody_there_ = true;
    else if (other_versions_.size() < max_versions)
        other_versions_.insert(version);
}

std::string Received::text() const {
    std::vector<std::string> texts, names;
    for (const std::string& each : names_)
        if (const auto name = TopicName::of(each))
            names.push_back(fmt::format("{} in partition {}", name->topic, name->partition));
    if (!names.empty())
        texts.push_back(fmt::format("available are {}", fmt::join(names, ", ")));
    else if (is_anybody_there_)
        texts.push_back(fmt::format("no name that ends in {} is offered", ending_));
    else if (other_versions_.empty())
        texts.push_back("no program of Gazebo is found: is Gazebo running, on this machine or in its network?");
    for (const uint32_t version : other_versions_)
        texts.push_back(version == statistics_version
                            ? "programs with GZ_TRANSPORT_TOPIC_STATISTICS are running, which other programs ignore: "
                              "unset it for Gazebo"
                            : fmt::format("programs with version {} of Gazebo's discovery are running; version {} is "
                                          "supported",
                                          version, discovery_version));
    return fmt::format("{}", fmt::join(texts, "; "));
}

std::optional<Announcement> readDatagram(std::string_view datagram, const std::string& own_process,
                                         Received& received) {
    if (datagram.size() < 2) return {};
    const size_t size = static_cast<uint8_t>(datagram[0]) | size_t{static_cast<uint8_t>(datagram[1])} << 8;
    if (size + 2 != datagram.size()) return {};
    wire::Discovery message;
    if (!message.ParseFromArray(datagram.data() + 2, static_cast<int>(size))) return {};
    if (message.process_uuid().empty() || message.process_uuid() == own_process) return {};
    received.addVersion(message.version());
    if (message.version() != discovery_version || message.flags().relay()) return {};
    const auto kind = kindOf(message.type());
    if (!kind) return {};
    Announcement announcement{*kind, message.process_uuid(), {}};
    if (*kind != Announcement::Kind::Offer && *kind != Announcement::Kind::Withdrawal) return announcement;
    const bool is_whole = message.pub().has_msg_pub() || message.pub().has_srv_pub();
    if (!is_whole || !message.pub().address().starts_with("tcp://")) return {};
    if (message.pub().scope() == wire::Discovery::Publisher::PROCESS) return {};
    announcement.publication = publicationOf(message.pub());
    if (*kind == Announcement::Kind::Offer) received.add(announcement.publication);
    return announcement;
}

std::string askDatagram(const std::string& process, const std::string& topic) {
    wire::Discovery message = messageOf(process, wire::Discovery::SUBSCRIBE);
    message.mutable_sub()->set_topic(topic);
    return framed(message);
}

std::string aliveDatagram(const std::string& process) { return framed(messageOf(process, wire::Discovery::HEARTBEAT)); }

std::string goodbyeDatagram(const std::string& process) { return framed(messageOf(process, wire::Discovery::BYE)); }

std::string connectionDatagram(const std::string& process, const std::string& node, const Publication& publication,
                               bool begins) {
    wire::Discovery message =
        messageOf(process, begins ? wire::Discovery::NEW_CONNECTION : wire::Discovery::END_CONNECTION);
    wire::Discovery::Publisher& pub = *message.mutable_pub();
    pub.set_topic(publication.topic);
    pub.set_address(publication.address);
    pub.set_process_uuid(process);
    pub.set_node_uuid(node);
    pub.set_scope(wire::Discovery::Publisher::ALL);
    pub.mutable_msg_pub()->set_ctrl(publication.process);  // the recipient
    pub.mutable_msg_pub()->set_msg_type(publication.type);
    return framed(message);
}

}  // namespace insonify::gazebo
