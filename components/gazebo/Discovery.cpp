#include "components/gazebo/Discovery.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gazebo_messages.pb.h>  // made by the build, of messages.proto

#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>
#include <zmq.hpp>
#include <zmq_addon.hpp>

#include "components/gazebo/Multicast.hpp"
#include "components/gazebo/TransportOptions.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::gazebo {
namespace {

using ReplyClock = std::chrono::steady_clock;
using Milliseconds = std::chrono::milliseconds;
constexpr int64_t max_reply = int64_t{1} << 30;  // [bytes]
constexpr Milliseconds ask_period{300};          // between requests for publishers of the service

/** Returns the last two parts of a name, such as "/scene/info". */
std::string endingOfService(const std::string& name) {
    const size_t last = name.rfind('/');
    return last == std::string::npos || last == 0 ? name : name.substr(name.rfind('/', last - 1));
}

/** Waits for one of the items, or until `end`. */
void waitFor(std::vector<zmq::pollitem_t> items, ReplyClock::time_point end) {
    const auto left = std::chrono::ceil<Milliseconds>(end - ReplyClock::now());
    try {
        zmq::poll(items, std::clamp(left, Milliseconds{0}, ask_period));
    } catch (const zmq::error_t&) {  // a signal
    }
}

class Caller {
public:
    Caller(const TransportOptions& options, const Service& service, std::string name,
           std::chrono::duration<double> timeout)
        : options_(options),
          service_(service),
          name_(std::move(name)),
          timeout_(timeout),
          end_(ReplyClock::now() + std::chrono::duration_cast<ReplyClock::duration>(timeout)),
          multicast_(options, options.service_port),
          received_(endingOfService(service.name)) {}

    Reply call(const std::string& message) {
        const std::optional<Publication> found = find();
        if (!found)
            return {"", other_types_.empty() ? fmt::format("is not offered in partition {} within {:g} s (timeout); {}",
                                                           options_.partition, timeout_.count(), received_.text())
                                             : fmt::format("takes {}, not {} and {}", other_types_,
                                                           service_.request_type, service_.reply_type)};
        zmq::context_t context;
        zmq::socket_t replies(context, zmq::socket_type::dealer), requests(context, zmq::socket_type::dealer);
        for (zmq::socket_t* socket : {&replies, &requests}) socket->set(zmq::sockopt::linger, 0);
        replies.set(zmq::sockopt::maxmsgsize, max_reply);
        replies.set(zmq::sockopt::routing_id, process_);
        try {
            replies.bind("tcp://" + addressTowards(found->address, options_) + ":*");
            requests.connect(found->address);
        } catch (const zmq::error_t& error) {
            return {"", fmt::format("is at {}, which cannot be reached: {}", found->address, error.what())};
        }
        const std::string mark = makeUuid();
        const std::string frames[] = {name_,       replies.get(zmq::sockopt::last_endpoint),
                                      process_,    node_,
                                      mark,        message,
                                      found->type, found->reply_type};
        for (const std::string& frame : frames)
            requests.send(zmq::buffer(frame),
                          &frame == std::end(frames) - 1 ? zmq::send_flags::none : zmq::send_flags::sndmore);
        return awaitReply(replies, mark, found->address);
    }

private:
    /** Returns the publication of the service; none when nobody offers it within the timeout. */
    std::optional<Publication> find() {
        for (auto next = ReplyClock::now(); ReplyClock::now() < end_;) {
            if (ReplyClock::now() >= next) {
                multicast_.send(askDatagram(process_, name_));
                next = ReplyClock::now() + ask_period;
            }
            waitFor({{nullptr, multicast_.descriptor(), ZMQ_POLLIN, 0}}, std::min(next, end_));
            while (const auto datagram = multicast_.receive())
                if (const auto news = readDatagram(datagram->bytes, process_, received_);
                    news && takesOffer(*news, *datagram))
                    return news->publication;
        }
        return {};
    }

    bool takesOffer(const Announcement& news, const Multicast::Datagram& datagram) {
        const Publication& offer = news.publication;
        if (news.kind != Announcement::Kind::Offer || !offer.is_service || offer.topic != name_) return false;
        if (offer.is_for_host && !datagram.is_from_here) return false;
        if (messageName(offer.type) == service_.request_type && messageName(offer.reply_type) == service_.reply_type)
            return true;
        other_types_ = offer.type + " and returns " + offer.reply_type;
        return false;
    }

    Reply awaitReply(zmq::socket_t& replies, const std::string& mark, const std::string& address) const {
        while (ReplyClock::now() < end_) {
            waitFor({{replies.handle(), 0, ZMQ_POLLIN, 0}}, end_);
            std::vector<zmq::message_t> frames;
            if (!zmq::recv_multipart(replies, std::back_inserter(frames), zmq::recv_flags::dontwait)) continue;
            // service, node, mark of the request, message, success
            if (frames.size() < 5 || frames[2].to_string_view() != mark) continue;
            if (frames[4].to_string_view() != "1") return {"", "reports a failure"};
            return {frames[3].to_string(), ""};
        }
        return {"",
                fmt::format("is offered at {}, and does not answer within {:g} s (timeout): is Gazebo still starting, "
                            "or does a firewall stop TCP between it and this machine?",
                            address, timeout_.count())};
    }

    const TransportOptions& options_;
    const Service& service_;
    const std::string name_;  ///< With the partition.
    const std::chrono::duration<double> timeout_;
    const ReplyClock::time_point end_;
    const std::string process_ = makeUuid(), node_ = makeUuid();
    Multicast multicast_;
    Received received_;
    std::string other_types_;  ///< Types of a service with this name but other types.
};

constexpr size_t max_received = 100, max_versions = 3;

std::string framed(const wire::Discovery& message) {
    std::string datagram(2, '\0');
    message.AppendToString(&datagram);
    const size_t size = datagram.size() - 2;
    datagram[0] = static_cast<char>(size & 0xff);
    datagram[1] = static_cast<char>(size >> 8);
    return datagram;
}

wire::Discovery makeMessage(const std::string& process, wire::Discovery::Type type) {
    wire::Discovery message;
    message.set_version(discovery_version);
    message.set_process_uuid(process);
    message.set_type(type);
    return message;
}

std::optional<Announcement::Kind> getKind(wire::Discovery::Type type) {
    switch (type) {
        case wire::Discovery::ADVERTISE: return Announcement::Kind::Offer;
        case wire::Discovery::SUBSCRIBE: return Announcement::Kind::Question;
        case wire::Discovery::UNADVERTISE: return Announcement::Kind::Withdrawal;
        case wire::Discovery::BYE: return Announcement::Kind::Goodbye;
        case wire::Discovery::HEARTBEAT: return Announcement::Kind::Alive;
        default: return {};
    }
}

Publication readPublication(const wire::Discovery::Publisher& message) {
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

Reply request(const TransportOptions& options, const Service& service, const std::string& message,
              std::chrono::duration<double> timeout) {
    const auto name = qualifiedName(options.partition, service.name);
    if (!name) throw types::ConfigError("", "", "is no name that Gazebo's transport takes");
    return Caller(options, service, *name, timeout).call(message);
}

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
    const auto kind = getKind(message.type());
    if (!kind) return {};
    Announcement announcement{*kind, message.process_uuid(), {}};
    if (*kind == Announcement::Kind::Question) announcement.publication.topic = message.sub().topic();
    if (*kind != Announcement::Kind::Offer && *kind != Announcement::Kind::Withdrawal) return announcement;
    const bool is_whole = message.pub().has_msg_pub() || message.pub().has_srv_pub();
    if (!is_whole || !message.pub().address().starts_with("tcp://")) return {};
    if (message.pub().scope() == wire::Discovery::Publisher::PROCESS) return {};
    announcement.publication = readPublication(message.pub());
    if (*kind == Announcement::Kind::Offer) received.add(announcement.publication);
    return announcement;
}

std::string askDatagram(const std::string& process, const std::string& topic) {
    wire::Discovery message = makeMessage(process, wire::Discovery::SUBSCRIBE);
    message.mutable_sub()->set_topic(topic);
    return framed(message);
}

std::string aliveDatagram(const std::string& process) {
    return framed(makeMessage(process, wire::Discovery::HEARTBEAT));
}

std::string goodbyeDatagram(const std::string& process) { return framed(makeMessage(process, wire::Discovery::BYE)); }

std::string offerDatagram(const Publication& publication, bool begins) {
    wire::Discovery message =
        makeMessage(publication.process, begins ? wire::Discovery::ADVERTISE : wire::Discovery::UNADVERTISE);
    wire::Discovery::Publisher& pub = *message.mutable_pub();
    pub.set_topic(publication.topic);
    pub.set_address(publication.address);
    pub.set_process_uuid(publication.process);
    pub.set_node_uuid(publication.node);
    pub.set_scope(wire::Discovery::Publisher::ALL);
    pub.mutable_msg_pub()->set_ctrl(publication.process);
    pub.mutable_msg_pub()->set_msg_type(publication.type);
    return framed(message);
}

std::string connectionDatagram(const std::string& process, const std::string& node, const Publication& publication,
                               bool begins) {
    wire::Discovery message =
        makeMessage(process, begins ? wire::Discovery::NEW_CONNECTION : wire::Discovery::END_CONNECTION);
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
