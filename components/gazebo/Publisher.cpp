#include "components/gazebo/Publisher.hpp"

#include <fmt/format.h>
#include <gazebo_messages.pb.h>  // made by the build, of messages.proto

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <iterator>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>
#include <zmq.hpp>
#include <zmq_addon.hpp>

#include "components/gazebo/Discovery.hpp"
#include "components/gazebo/Multicast.hpp"
#include "types/Thread.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::gazebo {
namespace {

void add(wire::Header& header, const char* key, const std::vector<std::string>& values) {
    wire::Header::Map& entry = *header.add_data();
    entry.set_key(key);
    for (const std::string& value : values) entry.add_value(value);
}

void fill(wire::Header& header, const Stamp& stamp) {
    constexpr int64_t per_second = 1'000'000;
    int64_t seconds = stamp.time.microseconds / per_second, rest = stamp.time.microseconds % per_second;
    if (rest < 0) --seconds, rest += per_second;
    header.mutable_stamp()->set_sec(seconds);
    header.mutable_stamp()->set_nsec(static_cast<int32_t>(rest * 1000));
    add(header, "frame_id", {stamp.frame_id});
}

/** The value of Gazebo's enum of pixels. */
uint32_t pixelFormat(const std::string& encoding) {
    if (encoding == "mono8") return 1;
    if (encoding == "mono16") return 2;
    if (encoding == "rgb8") return 3;
    if (encoding == "bgr8") return 8;
    throw std::invalid_argument("is a picture of " + encoding + ", which Gazebo's Image does not have");
}

/** The value of Gazebo's enum of fields, which begins with INT8 = 0; that of ROS with INT8 = 1. */
uint32_t fieldType(uint8_t datatype) {
    if (datatype < 1 || datatype > 8) throw std::invalid_argument("has a field of an unknown type");
    return datatype - 1u;
}

}  // namespace

std::string encode(const ros::Image& picture, const Stamp& stamp) {
    wire::Image message;
    fill(*message.mutable_header(), stamp);
    message.set_width(picture.width);
    message.set_height(picture.height);
    message.set_step(picture.step);
    message.set_pixel_format_type(pixelFormat(picture.encoding));
    message.mutable_data()->assign(picture.data.begin(), picture.data.end());
    return message.SerializeAsString();
}

std::string encode(const ros::LaserScan& scan, const Stamp& stamp) {
    wire::LaserScan message;
    fill(*message.mutable_header(), stamp);
    message.set_frame(stamp.frame_id);
    message.set_angle_min(scan.angle_min);
    message.set_angle_max(scan.angle_max);
    message.set_angle_step(scan.angle_increment);
    message.set_range_min(scan.range_min);
    message.set_range_max(scan.range_max);
    message.set_count(static_cast<uint32_t>(scan.ranges.size()));
    for (const float range : scan.ranges) message.add_ranges(range);
    for (const float intensity : scan.intensities) message.add_intensities(intensity);
    return message.SerializeAsString();
}

std::string encode(const ros::PointCloud2& cloud, const Stamp& stamp) {
    wire::PointCloudPacked message;
    fill(*message.mutable_header(), stamp);
    for (const ros::PointField& field : cloud.fields) {
        wire::PointCloudPacked::Field& written = *message.add_field();
        written.set_name(field.name);
        written.set_offset(field.offset);
        written.set_datatype(fieldType(field.datatype));
        written.set_count(field.count);
    }
    message.set_height(cloud.height);
    message.set_width(cloud.width);
    message.set_is_bigendian(cloud.is_bigendian);
    message.set_point_step(cloud.point_step);
    message.set_row_step(cloud.row_step);
    message.mutable_data()->assign(cloud.data.begin(), cloud.data.end());
    message.set_is_dense(cloud.is_dense);
    return message.SerializeAsString();
}

std::string encode(const types::Sonar& ping, const Stamp& stamp) {
    if (const char* wrong = ping.diagnostic()) throw std::invalid_argument(wrong);
    wire::FloatV message;
    fill(*message.mutable_header(), stamp);
    wire::Header& header = *message.mutable_header();
    add(header, "beam_count", {std::to_string(ping.beam_count)});
    add(header, "bin_count", {std::to_string(ping.bin_count)});
    add(header, "bin_width", {fmt::format("{}", ping.binWidth())});
    add(header, "speed_of_sound", {fmt::format("{}", ping.speed_of_sound)});
    std::vector<std::string> bearings;
    for (const types::Angle& bearing : ping.bearings) bearings.push_back(fmt::format("{}", bearing.rad));
    add(header, "bearings", bearings);
    message.mutable_data()->Add(ping.bins.begin(), ping.bins.end());
    return message.SerializeAsString();
}

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

    /** Returns whether a topic is in the partition of the offers: in others there may be another version of Gazebo. */
    bool isOurs(const std::string& topic) const {
        const auto name = TopicName::of(topic), own = TopicName::of(offers_.front().topic);
        return name && own && name->partition == own->partition;
    }

    void readDatagrams() {
        while (const auto datagram = multicast_.receive()) {
            const auto news = readDatagram(datagram->bytes, process(), others_);
            if (!news) continue;
            const Publication& publication = news->publication;
            if (news->kind == Announcement::Kind::Offer && !scope_ && isOurs(publication.topic))
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
