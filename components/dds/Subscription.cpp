#include "components/dds/Subscription.hpp"

#include <dds/dds.h>
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "components/ros/Cdr.hpp"
#include "components/ros/Poses.hpp"
#include "components/ros/Schema.hpp"
#include "components/ros/Stamps.hpp"
#include "types/Time.hpp"
#include "types/geometry/WorldFrame.hpp"

namespace insonify::dds {
namespace {

constexpr size_t max_attitudes = 10'000;  ///< Kept orientations of a body; they span at most max_age.
constexpr types::Time max_age{5'000'000};
constexpr int orientation_depth = 1000;  ///< They wait until a fix arrives, or a second.
constexpr int min_depth = 64;         ///< So that invalid messages do not displace a valid message before it is read.
constexpr int max_drops = 64;         ///< In one take(): a sender of invalid messages blocks nobody.
constexpr size_t maximum = 64 << 10;  ///< A message's 712 bytes and two names, rounded up [B].
constexpr types::Time max_ahead{1'000'000};    ///< Max stamp ahead of the clock; a sonar refuses later snapshots too.
constexpr types::Time max_silence{1'000'000};  ///< After it, a sender's clock may have been set back.
constexpr types::Time max_apart{1'000'000};    ///< Of a fix and the nearest orientation.

/** Returns "odometry" for "rt/auv/odometry". */
std::string_view lastWord(std::string_view topic) { return topic.substr(topic.rfind('/') + 1); }

/** Returns at most five similar topics: of the same type, or with the same last word. */
std::string similarTopics(const std::vector<Published>& all, const std::string& topic, const std::string& type) {
    constexpr size_t max_named = 5;
    constexpr std::string_view prefix = "rt";
    std::set<std::string> similar;
    for (const Published& published : all)
        if (published.topic.starts_with("rt/") &&
            (published.type == type || lastWord(published.topic) == lastWord(topic)))
            similar.insert(fmt::format("{} ({})", published.topic.substr(prefix.size()), rosType(published.type)));
    std::string text;
    size_t named = 0;
    for (const std::string& name : similar)
        if (named++ < max_named) text += (text.empty() ? "" : ", ") + name;
    return text;
}

Reader reader(Node& node, Reliability reliability, const std::string& topic, const auto& message, int queue,
              std::function<void()> arrived) {
    return std::visit(
        [&]<class T>(const T&) -> Reader {
            const Quality quality{.reliability = reliability, .depth = queue};
            return {node, ddsTopic(topic), T::type_name, ros::typeHash<T>(), quality, std::move(arrived), maximum};
        },
        message);
}

}  // namespace

SubscriberConfig SubscriberConfig::namedBy(const types::RosNames& names, const std::string& task) const {
    SubscriberConfig named = *this;
    named.node.node_name = node.nameIn(names, task);
    for (TopicIn& topic : named.topics) {
        topic.topic = names.topic(topic.topic, named.node.node_name);
        if (topic.orientation) topic.orientation->topic = names.topic(topic.orientation->topic, named.node.node_name);
    }
    return named;
}

void SubscriberConfig::check(types::Diagnostics& diagnostics) const {
    node.check(diagnostics);
    if (topics.empty()) diagnostics.push_back({"topics", "is empty; must hold a topic"});
    const auto checkTopic = [&](const std::string& path, const std::string& topic) {
        if (const std::string diagnostic = diagnosticOfTopic(topic); !diagnostic.empty())
            diagnostics.push_back({path, diagnostic});
    };
    std::set<std::string> ports;
    for (size_t i = 0; i < topics.size(); ++i) {
        const std::string path = "topics[" + std::to_string(i) + "].";
        checkTopic(path + "topic", topics[i].topic);
        if (!ports.insert(topics[i].port).second)
            diagnostics.push_back({path + "port", "is " + topics[i].port + " a second time"});
        if (!topics[i].orientation) continue;
        checkTopic(path + "orientation.topic", topics[i].orientation->topic);
        if (topics[i].type != PoseType::NavSatFix)
            diagnostics.push_back(
                {path + "orientation",
                 fmt::format("is given for {}, which has its own; may be given "
                             "for sensor_msgs/NavSatFix only",
                             types::EnumNames<PoseType>::names[static_cast<size_t>(topics[i].type)])});
    }
}

bool SubscriberConfig::hasFixes() const {
    return std::ranges::find(topics, PoseType::NavSatFix, &TopicIn::type) != topics.end();
}

Subscription::Message Subscription::makeMessage(PoseType type) {
    if (type == PoseType::Odometry) return ros::Odometry{};
    if (type == PoseType::PoseStamped) return ros::PoseStamped{};
    if (type == PoseType::NavSatFix) return ros::NavSatFix{};
    return ros::PoseWithCovarianceStamped{};
}

Subscription::Message Subscription::makeMessage(OrientationType type) {
    if (type == OrientationType::Imu) return ros::Imu{};
    if (type == OrientationType::Odometry) return ros::Odometry{};
    if (type == OrientationType::PoseStamped) return ros::PoseStamped{};
    return ros::PoseWithCovarianceStamped{};
}

const char* Subscription::getType() const {
    return std::visit([]<class T>(const T&) { return T::type_name; }, message_);
}

Subscription::Subscription(Node& node, const SubscriberConfig& config, const std::string& topic, StampFrom stamp,
                           Message message, int queue, Counts& counts, std::function<void()> arrived)
    : topic_(topic),
      domain_(domainId(config.node.domain)),
      reliability_(config.reliability),
      message_(std::move(message)),
      datum_(config.datum),
      world_frame_(config.node.world_frame),
      stamped_on_arrival_(stamp == StampFrom::Arrival),
      counts_(counts),
      reader_(reader(node, reliability_, topic, message_, queue, std::move(arrived))) {
    node.addReader(reader_.handle());
}

Subscription::Subscription(Node& node, const SubscriberConfig& config, const TopicIn& topic, Counts& counts,
                           std::function<void()> arrived)
    : Subscription(node, config, topic.topic, topic.stamp, makeMessage(topic.type), std::max(config.depth, min_depth),
                   counts, std::move(arrived)) {
    if (topic.orientation)
        orientation_.reset(new Subscription(node, config, topic.orientation->topic, topic.stamp,
                                            makeMessage(topic.orientation->type), orientation_depth, counts, {}));
}

std::string Subscription::decode() {
    return std::visit(
        [this](auto& message) {
            ros::decode(std::span<const char>(bytes_), message);
            stamp_ = message.header.stamp;
            return convert(message);
        },
        message_);
}

std::string Subscription::convert(const auto& message) {
    ros::convert(message, world_frame_, read_);
    return types::isUsable(read_) ? "" : "position and orientation are not finite, or the orientation has no length";
}

std::string Subscription::convert(const ros::Imu& message) {
    ros::convert(message, world_frame_, imu_);
    read_ = {};
    read_.time = imu_.time;
    read_.orientation = imu_.orientation;
    return types::isUsable(read_) ? "" : "the orientation is unknown (covariance -1), not finite or without a length";
}

std::string Subscription::convert(const ros::NavSatFix& message) {
    ros::convert(message, fix_);
    if (fix_.kind == types::FixKind::NoSolution) return "the receiver has no fix (status below 0)";
    const auto placed = types::placeFix(fix_, *datum_);
    if (!placed) return "latitude or longitude is not on the earth, or the altitude is beyond 10,000 km";
    read_ = *placed;
    read_.source_frame = message.header.frame_id;
    return "";
}

void Subscription::takeOrientations(types::Time now) {
    while (orientation_->takeNext(now)) {
        const types::Pose& taken = orientation_->read_;
        if (!attitudes_.empty() && taken.time < attitudes_.back().time) attitudes_.clear();  // the clock was set back
        attitudes_.push_back({taken.time, taken.orientation});
        while (attitudes_.size() > max_attitudes || attitudes_.front().time < taken.time - max_age)
            attitudes_.pop_front();
    }
}

std::string Subscription::turn() {
    if (!orientation_) return "";
    if (attitudes_.empty() || attitudes_.back().time < read_.time - max_apart ||
        read_.time + max_apart < attitudes_.front().time)
        return "no orientation of " + orientation_->topic_ + " is within a second of the fix";
    read_.orientation = types::findOrientation(attitudes_, read_.time);
    return "";
}

std::string Subscription::findDiagnostic(types::Time now, const types::Pose& pose) {
    if (pose.time - now > max_ahead) return "the stamp is more than a second ahead of the clock";
    if (pose.time >= newest_ || types::elapsed(newest_came_, now) > max_silence) return "";
    const bool sender_lives = sender_ == newest_sender_ || reader_.receives(newest_sender_);
    return sender_lives ? "the stamp is before that of the previous pose" : "";
}

std::string Subscription::absence(Node& node) const {
    const std::string topic = ddsTopic(topic_), type = ddsType(getType());
    const std::vector<Published> all = node.published();
    const auto writers = std::ranges::count(all, topic, &Published::topic);
    const auto of_type = std::ranges::count_if(
        all, [&](const Published& published) { return published.topic == topic && published.type == type; });
    const std::string what = fmt::format("{} ({}, domain {})", topic_, rosType(type), domain_);
    if (writers == 0) {
        const std::string similar = similarTopics(all, topic, type);
        return fmt::format("nobody publishes {}{}", what, similar.empty() ? "" : "; there are " + similar);
    }
    if (of_type == 0) {
        const auto other = std::ranges::find(all, topic, &Published::topic);
        return fmt::format("{} is published as {}; set `type`", what, rosType(other->type));
    }
    if (dds_get_matched_publications(reader_.handle(), nullptr, 0) == 0)
        return fmt::format("{} has {} publishers, none of whose QoS fits `reliability: {}`", what, of_type,
                           reliability_ == Reliability::Reliable ? "reliable" : "best_effort");
    if (orientation_ && attitudes_.empty()) return "no orientation: " + orientation_->absence(node);
    return fmt::format("{} has {} publishers, which send nothing that can be used", what, of_type);
}

bool Subscription::take(types::Time now, types::Pose& pose) {
    if (orientation_) takeOrientations(now);
    if (!takeNext(now)) return false;
    if (read_.time == ros::fromRos(stamp_)) ros::fineStamps().note(stamp_);
    const double away = glm::length(read_.position);
    if (std::holds_alternative<ros::NavSatFix>(message_) && !std::exchange(was_placed_, true) &&
        away > types::far_from_datum)
        counts_.far.add(topic_ + " begins more than 100 km from the datum; is that of another place?",
                        fmt::format("; it is {:.0f} km", away / 1e3));
    std::swap(pose, read_);
    return true;
}

bool Subscription::takeNext(types::Time now) {
    more_ = false;
    for (int drops = 0; drops < max_drops; ++drops) {
        if (!reader_.take(bytes_, sender_)) return false;
        std::string diagnostic, detail;
        try {
            diagnostic = decode();
            if (stamped_on_arrival_ || read_.time == types::Time{}) read_.time = now;
            if (diagnostic.empty()) diagnostic = findDiagnostic(now, read_);
            if (diagnostic.empty()) diagnostic = turn();
        } catch (const ros::CdrError& error) {
            diagnostic = bytes_.empty() ? "empty, or larger than any message of its type" : "not a message of its type";
            detail = std::string(": ") + error.what();
        }
        if (diagnostic.empty()) {
            newest_ = read_.time;
            newest_came_ = now;
            newest_sender_ = sender_;
            if (types::isOddlyLong(read_.orientation))
                counts_.odd.add(
                    topic_ + ": the quaternion's length is not 1: are its parts degrees, or of another order",
                    fmt::format("; its length is {:.4g}", glm::length(read_.orientation)));
            read_.orientation = glm::normalize(read_.orientation);
            return true;
        }
        counts_.drops.add(topic_ + ": " + diagnostic, detail);
    }
    more_ = true;
    return false;
}

}  // namespace insonify::dds
