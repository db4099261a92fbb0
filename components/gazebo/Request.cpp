#include "components/gazebo/Request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>
#include <zmq.hpp>
#include <zmq_addon.hpp>

#include "components/gazebo/Discovery.hpp"
#include "components/gazebo/Multicast.hpp"
#include "types/ConfigError.hpp"

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

}  // namespace

Reply request(const TransportOptions& options, const Service& service, const std::string& message,
              std::chrono::duration<double> timeout) {
    const auto name = qualifiedName(options.partition, service.name);
    if (!name) throw types::ConfigError("", "", "is no name that Gazebo's transport takes");
    return Caller(options, service, *name, timeout).call(message);
}

}  // namespace insonify::gazebo
