#pragma once
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "components/dds/Endpoints.hpp"
#include "components/ros/NodeMessages.hpp"
#include "components/ros/Schema.hpp"
#include "types/text/RosNames.hpp"

namespace insonify::dds {

/** Sends the messages of one topic of a node itself. */
template <class Message>
class MessageWriter {
public:
    MessageWriter(Node& node, const std::string& topic, const Quality& quality)
        : writer_(node, ddsTopic(topic), Message::type_name, ros::typeHash<Message>(), quality) {
        node.addWriter(writer_.handle());
    }
    bool hasReaders() const { return writer_.hasReaders(); }
    /** Messages that DDS does not take are lost. */
    void send(const Message& message) {
        bytes_.clear();
        ros::encode(message, bytes_);
        writer_.write(bytes_);
    }

private:
    Writer writer_;
    Bytes bytes_;
};

/** The services of a ROS 2 node, and its regular work, on one thread, as in ROS's default executor.
 *
 *  A service is what rmw_cyclonedds_cpp makes of it: a topic of requests and one of replies, each message after the 16
 *  bytes by which the client knows its reply, both ends announced with the same `serviceid` and the hash of their type.
 *  A request that is not one of its type, or that no answer is possible to, is ignored: the client's wait ends by
 *  itself. */
class NodeServer {
public:
    /** @param node_name its full name
     *  @param names remap the names of services
     *  The node must outlive the server. */
    NodeServer(Node& node, std::string node_name, const types::RosNames& names = {});
    ~NodeServer();  ///< Waits for the request or work under way.
    NodeServer(const NodeServer&) = delete;
    NodeServer& operator=(const NodeServer&) = delete;

    const std::string& nodeName() const { return node_name_; }
    Node& node() { return node_; }
    /** Returns the name of a topic of the node, such as "~/x" or "/rosout", after the remappings. */
    std::string named(const std::string& topic) const { return names_.topic(topic, node_name_); }

    /** Offers a service; before start(). Throws types::ConfigError.
     *  @param answer fills the response; called on the server's thread */
    template <class Request, class Response>
    void serve(const ros::Service<Request, Response>& service, std::function<void(const Request&, Response&)> answer) {
        offer(service.name, Request::type_name, ros::typeHash<Request>(), Response::type_name,
              ros::typeHash<Response>(), [answer = std::move(answer)](std::span<const char> request, Bytes& reply) {
                  Request asked;
                  Response said;
                  ros::decode(request, asked);
                  answer(asked, said);
                  ros::encode(said, reply);
              });
    }
    /** Calls `work` on the server's thread every `period`, and at its start; before start(). */
    void every(std::chrono::milliseconds period, std::function<void()> work);
    /** Starts the thread. */
    void start();

private:
    using Clock = std::chrono::steady_clock;
    using Answer = std::function<void(std::span<const char> request, Bytes& reply)>;
    struct Offered {
        std::unique_ptr<Reader> requests;
        std::unique_ptr<Writer> replies;
        Answer answer;
    };
    struct Work {
        std::chrono::milliseconds period;
        Clock::time_point due;
        std::function<void()> work;
    };

    void offer(const char* name, const char* request, const std::string& request_hash, const char* response,
               const std::string& response_hash, Answer answer);
    void run();
    bool ends();
    void answerAll();
    /** Does what is due; returns when the next is. */
    Clock::time_point doWork();

    Node& node_;
    std::string node_name_;
    types::RosNames names_;
    std::mutex mutex_;
    std::condition_variable arrived_;
    bool has_arrived_ = false, ends_ = false;  ///< Under the mutex.
    std::vector<Offered> services_;
    std::vector<Work> works_;
    std::thread thread_;
};

}  // namespace insonify::dds
