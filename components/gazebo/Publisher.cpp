#include "components/gazebo/Publisher.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <iterator>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <zmq.hpp>
#include <zmq_addon.hpp>

#include "components/gazebo/Discovery.hpp"
#include "components/gazebo/Multicast.hpp"
#include "types/Thread.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::gazebo {
namespace {

using OfferClock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds offer_period{1000};  ///< Between two offers, the same for all programs.
constexpr std::chrono::seconds scope_patience{3};        ///< Until the scope of types is decided without others.

/** Returns "ignition.msgs." or "gz.msgs."; none for other types. */
std::optional<std::string> scopeIn(const std::string& type) {
    for (const char* scope : {"ignition.msgs.", "gz.msgs."})
        if (type.starts_with(scope)) return scope;
    return {};
}

}  // namespace

/** A descriptor that becomes readable when it is raised. */
class Alarm {
public:
    Alarm() : descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}
    ~Alarm() { close(descriptor_); }
    Alarm(const Alarm&) = delete;
    Alarm& operator=(const Alarm&) = delete;

    int descriptor() const { return descriptor_; }
    void raise() const {
        const uint64_t one = 1;
        [[maybe_unused]] const auto written = write(descriptor_, &one, sizeof one);
    }
    void clear() const {
        uint64_t raised = 0;
        [[maybe_unused]] const auto count = read(descriptor_, &raised, sizeof raised);
    }

private:
    const int descriptor_;
};

class Publisher::Worker {
public:
    Worker(const TransportOptions& options, const std::vector<Offer>& offers)
        : multicast_(options, options.topic_port), has_readers_(offers.size()) {
        socket_.set(zmq::sockopt::linger, 0);
        socket_.set(zmq::sockopt::sndhwm, static_cast<int>(max_waiting));
        const std::string group = "tcp://" + options.group + ":" + std::to_string(options.topic_port);
        socket_.bind("tcp://" + addressTowards(group, options) + ":*");
        const std::string address = socket_.get(zmq::sockopt::last_endpoint), process = makeUuid(), node = makeUuid();
        for (size_t i = 0; i < offers.size(); ++i) {
            const auto name = qualifiedName(options.partition, offers[i].topic);
            if (!name) throw types::ConfigError("", std::to_string(i), "is no name of a topic");
            offers_.push_back({false, *name, address, process, node, offers[i].type, "", "", false});
        }
        thread_ = types::startThread("the topics for Gazebo", [this] { run(); });
    }
    ~Worker() {
        ends_ = true;
        alarm_.raise();
        thread_.join();
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    bool hasReaders(size_t offer) const { return has_readers_[offer]; }
    void publish(size_t offer, std::string message) {
        {
            const std::lock_guard lock(mutex_);
            if (waiting_.size() >= max_waiting) {
                waiting_.pop_front();
                ++lost_;
            }
            waiting_.emplace_back(offer, std::move(message));
        }
        alarm_.raise();
    }
    uint64_t lost() const { return lost_; }

private:
    void run() {
        while (!ends_) {
            const auto wait = std::chrono::ceil<std::chrono::milliseconds>(next_ - OfferClock::now());
            zmq::pollitem_t items[] = {{socket_.handle(), 0, ZMQ_POLLIN, 0},
                                       {nullptr, multicast_.descriptor(), ZMQ_POLLIN, 0},
                                       {nullptr, alarm_.descriptor(), ZMQ_POLLIN, 0}};
            try {
                zmq::poll(items, std::size(items), std::max(wait, std::chrono::milliseconds{0}));
                if (items[0].revents) readSubscriptions();
                if (items[1].revents) readDatagrams();
                if (items[2].revents) sendWaiting();
                if (OfferClock::now() >= next_) announce();
            } catch (const std::exception&) {
                continue;  // a signal, or a message that is too large for the memory: lost
            }
        }
        if (scope_)
            for (const Publication& offer : offers_) multicast_.send(offerDatagram(offer, false));
        multicast_.send(goodbyeDatagram(process()));
    }

    const std::string& process() const { return offers_.front().process; }

    /** Sends a heartbeat and all offers. */
    void announce() {
        next_ = OfferClock::now() + offer_period;
        if (!scope_ && OfferClock::now() - begin_ > scope_patience) decideScope("gz.msgs.");
        multicast_.send(aliveDatagram(process()));
        if (!scope_) return;
        for (const Publication& offer : offers_) multicast_.send(offerDatagram(offer, true));
    }

    void decideScope(const std::string& scope) {
        scope_ = scope;
        for (Publication& offer : offers_) offer.type = scope + offer.type;
        next_ = OfferClock::now();  // offers at once
    }

    void readDatagrams() {
        while (const auto datagram = multicast_.receive()) {
            const auto news = readDatagram(datagram->bytes, process(), others_);
            if (!news) continue;
            const Publication& publication = news->publication;
            if (news->kind == Announcement::Kind::Offer && !scope_)
                if (const auto scope = scopeIn(publication.type)) decideScope(*scope);
            if (news->kind != Announcement::Kind::Question || !scope_) continue;
            for (const Publication& offer : offers_)
                if (offer.topic == publication.topic) multicast_.send(offerDatagram(offer, true));
        }
    }

    /** Reads what programs subscribe to: a byte, 1 or 0 for the end, and the beginning of topics. */
    void readSubscriptions() {
        zmq::message_t message;
        while (socket_.recv(message, zmq::recv_flags::dontwait)) {
            const std::string_view bytes = message.to_string_view();
            if (bytes.empty()) continue;
            if (bytes[0] == 1)
                subscribed_.emplace(bytes.substr(1));
            else
                subscribed_.erase(std::string(bytes.substr(1)));
        }
        for (size_t i = 0; i < offers_.size(); ++i)
            has_readers_[i] = std::ranges::any_of(
                subscribed_, [&](const std::string& beginning) { return offers_[i].topic.starts_with(beginning); });
    }

    void sendWaiting() {
        alarm_.clear();
        for (;;) {
            std::pair<size_t, std::string> next;
            {
                const std::lock_guard lock(mutex_);
                if (waiting_.empty()) return;
                next = std::move(waiting_.front());
                waiting_.pop_front();
            }
            const Publication& offer = offers_[next.first];
            const std::string* const frames[] = {&offer.topic, &offer.address, &next.second};
            for (const std::string* frame : frames) socket_.send(zmq::buffer(*frame), zmq::send_flags::sndmore);
            socket_.send(zmq::buffer(offer.type), zmq::send_flags::none);
        }
    }

    std::vector<Publication> offers_;
    Multicast multicast_;
    zmq::context_t context_;
    zmq::socket_t socket_{context_, zmq::socket_type::xpub};  // tells what is read
    std::set<std::string, std::less<>> subscribed_;
    std::vector<std::atomic<bool>> has_readers_;  ///< For each topic.
    std::optional<std::string> scope_;            ///< Of types.
    Received others_{"/"};
    const OfferClock::time_point begin_ = OfferClock::now();
    OfferClock::time_point next_ = begin_;
    const Alarm alarm_;
    std::atomic<bool> ends_ = false;
    std::atomic<uint64_t> lost_ = 0;
    std::mutex mutex_;
    std::deque<std::pair<size_t, std::string>> waiting_;
    std::thread thread_;
};

Publisher::Publisher(const TransportOptions& options, const std::vector<Offer>& offers)
    : worker_(std::make_unique<Worker>(options, offers)) {}
Publisher::~Publisher() = default;
bool Publisher::hasReaders(size_t offer) const { return worker_->hasReaders(offer); }
void Publisher::publish(size_t offer, std::string message) { worker_->publish(offer, std::move(message)); }
uint64_t Publisher::lost() const { return worker_->lost(); }

}  // namespace insonify::gazebo
