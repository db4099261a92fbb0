#pragma once
// A replacement of Gazebo Harmonic where its transport is not available: the same datagrams and frames, with its names
// of types. Like gz-transport, it sends messages only to programs that have announced a connection.
#include <gazebo_messages.pb.h>

#include <atomic>
#include <functional>
#include <iterator>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>
#include <zmq.hpp>
#include <zmq_addon.hpp>

#include "components/gazebo/Discovery.hpp"
#include "components/gazebo/Multicast.hpp"
#include "components/gazebo/TransportOptions.hpp"

namespace insonify::gazebo {

class HarmonicWorld {
public:
    struct Settings {
        std::string world = "sea";
        std::string scene = {};                    ///< Reply of the service.
        std::string type = "gz.msgs.Pose_V";       ///< Type of the topic.
        std::string reply_type = "gz.msgs.Scene";  ///< Type of the service's reply.
        bool succeeds = true;
        bool answers = true;
        uint32_t version = discovery_version;
        std::string partition = TransportOptions::fromEnvironment("").partition;
    };

    explicit HarmonicWorld(Settings settings)
        : settings_(std::move(settings)),
          topic_("@/" + settings_.partition + "@/world/" + settings_.world + "/pose/info"),
          service_("@/" + settings_.partition + "@/world/" + settings_.world + "/scene/info"),
          topics_(options_, options_.topic_port),
          services_(options_, options_.service_port) {
        for (zmq::socket_t* socket : {&publisher_, &replier_}) {
            socket->set(zmq::sockopt::linger, 0);
            if (socket == &replier_) socket->set(zmq::sockopt::routing_id, socket_id_);
            socket->bind("tcp://127.0.0.1:*");
        }
        replier_.set(zmq::sockopt::router_mandatory, 1);
        service_address_ = replier_.get(zmq::sockopt::last_endpoint);  // before answers connect it to others
        thread_ = std::thread([this] { run(); });
    }
    ~HarmonicWorld() {
        stop_ = true;
        thread_.join();
    }
    HarmonicWorld(const HarmonicWorld&) = delete;
    HarmonicWorld& operator=(const HarmonicWorld&) = delete;

    /** Publishes a message; returns false if the topic has no subscribers. */
    bool publish(const std::string& message) {
        const std::lock_guard lock(mutex_);
        if (takers_.empty()) return false;
        const std::string frames[] = {topic_, publisher_.get(zmq::sockopt::last_endpoint), message, settings_.type};
        send(publisher_, frames);
        return true;
    }
    size_t takers() const {
        const std::lock_guard lock(mutex_);
        return takers_.size();
    }

private:
    template <size_t N>
    static void send(zmq::socket_t& socket, const std::string (&frames)[N]) {
        for (size_t i = 0; i < N; ++i)
            socket.send(zmq::buffer(frames[i]), i + 1 < N ? zmq::send_flags::sndmore : zmq::send_flags::none);
    }

    void run() {
        auto next = std::chrono::steady_clock::now();
        while (!stop_) {
            if (std::chrono::steady_clock::now() >= next) {
                offer();
                next += std::chrono::seconds(1);
            }
            zmq::pollitem_t items[] = {{replier_.handle(), 0, ZMQ_POLLIN, 0},
                                       {nullptr, topics_.descriptor(), ZMQ_POLLIN, 0},
                                       {nullptr, services_.descriptor(), ZMQ_POLLIN, 0}};
            zmq::poll(items, std::size(items), std::chrono::milliseconds(20));
            while (const auto datagram = topics_.receive()) read(datagram->bytes, topic_);
            while (const auto datagram = services_.receive()) read(datagram->bytes, service_);
            if (items[0].revents) answer();
        }
        send(wire::Discovery::BYE, topics_, {});
        send(wire::Discovery::BYE, services_, {});
    }

    void send(wire::Discovery::Type type, Multicast& to, const std::function<void(wire::Discovery::Publisher&)>& fill) {
        wire::Discovery message;
        message.set_version(settings_.version);
        message.set_process_uuid(process_);
        message.set_type(type);
        message.mutable_pub()->set_process_uuid(process_);
        if (fill) fill(*message.mutable_pub());
        const std::string body = message.SerializeAsString();
        to.send(std::string{static_cast<char>(body.size() & 0xff), static_cast<char>(body.size() >> 8)} + body);
    }

    void offer() {
        send(wire::Discovery::ADVERTISE, topics_, [&](wire::Discovery::Publisher& pub) {
            pub.set_topic(topic_);
            pub.set_address(publisher_.get(zmq::sockopt::last_endpoint));
            pub.set_node_uuid("node");
            pub.set_scope(wire::Discovery::Publisher::ALL);
            pub.mutable_msg_pub()->set_msg_type(settings_.type);
        });
        send(wire::Discovery::ADVERTISE, services_, [&](wire::Discovery::Publisher& pub) {
            pub.set_topic(service_);
            pub.set_address(service_address_);
            pub.set_node_uuid("node");
            pub.set_scope(wire::Discovery::Publisher::ALL);
            pub.mutable_srv_pub()->set_socket_id(socket_id_);
            pub.mutable_srv_pub()->set_request_type("gz.msgs.Empty");
            pub.mutable_srv_pub()->set_response_type(settings_.reply_type);
        });
    }

    void read(const std::string& datagram, const std::string& offered) {
        wire::Discovery message;
        if (!message.ParseFromString(datagram.substr(2)) || message.version() != settings_.version) return;
        if (message.type() == wire::Discovery::SUBSCRIBE && message.sub().topic() == offered) return offer();
        const std::lock_guard lock(mutex_);
        const bool is_ours = message.pub().topic() == topic_ && message.pub().msg_pub().ctrl() == process_;
        if (message.type() == wire::Discovery::NEW_CONNECTION && is_ours &&
            message.pub().msg_pub().msg_type() == settings_.type)
            takers_.insert(message.pub().process_uuid());
        if (message.type() == wire::Discovery::END_CONNECTION && is_ours) takers_.erase(message.pub().process_uuid());
    }

    void answer() {
        std::vector<zmq::message_t> frames;
        if (!zmq::recv_multipart(replier_, std::back_inserter(frames), zmq::recv_flags::dontwait)) return;
        const bool is_right = frames.size() == 9 && frames[1].to_string() == service_ &&
                              frames[7].to_string() == "gz.msgs.Empty" && frames[8].to_string() == settings_.reply_type;
        if (!is_right || !settings_.answers) return;
        replier_.connect(frames[2].to_string());
        std::this_thread::sleep_for(std::chrono::milliseconds(100));  // as gz-transport does
        const std::string reply[] = {frames[3].to_string(), service_,        frames[4].to_string(),
                                     frames[5].to_string(), settings_.scene, settings_.succeeds ? "1" : "0"};
        send(replier_, reply);
    }

    const Settings settings_;
    const TransportOptions options_ = TransportOptions::fromEnvironment("");
    const std::string topic_, service_, process_ = makeUuid(), socket_id_ = makeUuid();
    Multicast topics_, services_;
    zmq::context_t context_;
    zmq::socket_t publisher_{context_, zmq::socket_type::pub}, replier_{context_, zmq::socket_type::router};
    std::string service_address_;
    mutable std::mutex mutex_;  ///< Guards the publisher and the list of its subscribers.
    std::set<std::string> takers_;
    std::atomic<bool> stop_ = false;
    std::thread thread_;
};

}  // namespace insonify::gazebo
