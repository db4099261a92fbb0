#include "components/dds/NodeServer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "types/Thread.hpp"

namespace insonify::dds {
namespace {

constexpr size_t encapsulation = 4, identity = 16;  ///< At the beginning of a request and of its response [B].
constexpr size_t max_request = size_t{1} << 20;     ///< [B]
const Quality of_services{.reliability = Reliability::Reliable, .depth = 10};

/** Returns the pair that rmw_cyclonedds_cpp finds the two ends of a service by: 16 numbers of any choice that no other
 *  service has, here those that identify the reader's place in the domain. */
std::string serviceId(const Node& node, size_t number) {
    Guid id = node.guid();
    id[14] = static_cast<uint8_t>(number >> 8);
    id[15] = static_cast<uint8_t>(number);
    return fmt::format("serviceid={:x};", fmt::join(id, "."));
}

}  // namespace

NodeServer::NodeServer(Node& node, std::string node_name, const types::RosNames& names)
    : node_(node), node_name_(node_name.starts_with('/') ? "" : "/"), names_(names) {
    node_name_ += node_name;
}

NodeServer::~NodeServer() {
    {
        std::lock_guard lock(mutex_);
        ends_ = true;
    }
    arrived_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void NodeServer::offer(const char* name, const char* request, const std::string& request_hash, const char* response,
                       const std::string& response_hash, Answer answer) {
    const auto arrived = [this] {
        {
            std::lock_guard lock(mutex_);
            has_arrived_ = true;
        }
        arrived_.notify_all();
    };
    const std::string topic = named(std::string("~/") + name), id = serviceId(node_, services_.size());
    services_.push_back(
        {std::make_unique<Reader>(node_, "rq" + topic + "Request", request, request_hash, of_services, arrived,
                                  max_request, id),
         std::make_unique<Writer>(node_, "rr" + topic + "Reply", response, response_hash, of_services, id),
         std::move(answer)});
    node_.addReader(services_.back().requests->handle());
    node_.addWriter(services_.back().replies->handle());
}

void NodeServer::every(std::chrono::milliseconds period, std::function<void()> work) {
    works_.push_back({period, Clock::now(), std::move(work)});
}

void NodeServer::start() {
    thread_ = types::startThread("the ROS 2 services", [this] { run(); });
}

bool NodeServer::ends() {
    std::lock_guard lock(mutex_);
    return ends_;
}

void NodeServer::run() {
    while (true) {
        const Clock::time_point next = doWork();
        {
            std::unique_lock lock(mutex_);
            const auto wakes = [this] { return has_arrived_ || ends_; };
            if (next == Clock::time_point::max())
                arrived_.wait(lock, wakes);
            else
                arrived_.wait_until(lock, next, wakes);
            if (ends_) return;
            has_arrived_ = false;
        }
        answerAll();
    }
}

NodeServer::Clock::time_point NodeServer::doWork() {
    auto next = Clock::time_point::max();
    for (Work& each : works_) {
        const auto now = Clock::now();
        if (ends()) return next;
        if (now >= each.due) try {
                each.due = now + each.period;
                each.work();
            } catch (const std::exception&) {
                continue;  // what a report cannot say now, it says in the next period
            }
        next = std::min(next, each.due);
    }
    return next;
}

void NodeServer::answerAll() {
    Bytes bytes;
    uint64_t sender = 0;
    for (const Offered& service : services_)
        while (!ends() && service.requests->take(bytes, sender)) try {
                if (bytes.size() < encapsulation + identity) continue;
                const auto begin = bytes.begin() + encapsulation, end = begin + identity;
                const Bytes who(begin, end);
                bytes.erase(begin, end);
                Bytes reply;
                service.answer(bytes, reply);
                reply.insert(reply.begin() + encapsulation, who.begin(), who.end());
                service.replies->write(reply);
            } catch (const std::exception&) {
                continue;
            }
}

}  // namespace insonify::dds
