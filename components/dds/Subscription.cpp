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

constexpr int min_depth = 64;         ///< So that invalid messages do not displace a valid message before it is read.
constexpr int max_drops = 64;         ///< In one take(): a sender of invalid messages blocks nobody.
constexpr size_t maximum = 64 << 10;  ///< A message's 712 bytes and two names, rounded up [B].
constexpr types::Time max_ahead{1'000'000};    ///< Max stamp ahead of the clock; a sonar refuses later snapshots too.
constexpr types::Time max_silence{1'000'000};  ///< After it, a sender's clock may have been set back.

struct PoseMessage {
    const char* type;
    std::string hash;
};

PoseMessage makeMessage(PoseType type) {
    const auto of = []<class T>(std::type_identity<T>) { return PoseMessage{T::type_name, ros::typeHash<T>()}; };
    if (type == PoseType::Odometry) return of(std::type_identity<ros::Odometry>{});
    if (type == PoseType::PoseStamped) return of(std::type_identity<ros::PoseStamped>{});
    return of(std::type_identity<ros::PoseWithCovarianceStamped>{});
}

const char* getType(PoseType type) { return makeMessage(type).type; }

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

Reader reader(Node& node, const SubscriberConfig& config, const TopicIn& topic, std::function<void()> arrived) {
    const PoseMessage message = makeMessage(topic.type);
    const Quality quality{.reliability = config.reliability, .depth = std::max(config.depth, min_depth)};
    return {node, ddsTopic(topic.topic), message.type, message.hash, quality, std::move(arrived), maximum};
}

}  // namespace

Subscription::Subscription(Node& node, const SubscriberConfig& config, const TopicIn& topic,
                           types::ThrottledWarning& drops, types::ThrottledWarning& odd, std::function<void()> arrived)
    : topic_(topic.topic),
      domain_(domainId(config.node.domain)),
      reliability_(config.reliability),
      type_(topic.type),
      world_frame_(config.node.world_frame),
      stamped_on_arrival_(topic.stamp == StampFrom::Arrival),
      drops_(drops),
      odd_(odd),
      reader_(reader(node, config, topic, std::move(arrived))) {
    node.addReader(reader_.handle());
}

template <class Message>
void Subscription::decodeAs(Message& message, types::Pose& pose) {
    ros::decode(std::span<const char>(bytes_), message);
    ros::convert(message, world_frame_, pose);
    stamp_ = message.header.stamp;
}

void Subscription::decode(types::Pose& pose) {
    if (type_ == PoseType::Odometry)
        decodeAs(std::get<ros::Odometry>(messages_), pose);
    else if (type_ == PoseType::PoseStamped)
        decodeAs(std::get<ros::PoseStamped>(messages_), pose);
    else
        decodeAs(std::get<ros::PoseWithCovarianceStamped>(messages_), pose);
}

std::string Subscription::findDiagnostic(types::Time now, const types::Pose& pose) {
    if (!types::isUsable(pose)) return "position and orientation are not finite, or the orientation has no length";
    if (pose.time - now > max_ahead) return "the stamp is more than a second ahead of the clock";
    if (pose.time >= newest_ || types::elapsed(newest_came_, now) > max_silence) return "";
    const bool sender_lives = sender_ == newest_sender_ || reader_.receives(newest_sender_);
    return sender_lives ? "the stamp is before that of the previous pose" : "";
}

std::string Subscription::absence(Node& node) const {
    const std::string topic = ddsTopic(topic_), type = ddsType(getType(type_));
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
    return fmt::format("{} has {} publishers, which send nothing that can be used", what, of_type);
}

bool Subscription::take(types::Time now, types::Pose& pose) {
    more_ = false;
    for (int drops = 0; drops < max_drops; ++drops) {
        if (!reader_.take(bytes_, sender_)) return false;
        std::string diagnostic, detail;
        try {
            decode(read_);
            if (stamped_on_arrival_ || read_.time == types::Time{}) read_.time = now;
            diagnostic = findDiagnostic(now, read_);
        } catch (const ros::CdrError& error) {
            diagnostic = bytes_.empty() ? "empty, or larger than any message of its type" : "not a message of its type";
            detail = std::string(": ") + error.what();
        }
        if (diagnostic.empty()) {
            if (read_.time == ros::fromRos(stamp_)) ros::fineStamps().note(stamp_);
            newest_ = read_.time;
            newest_came_ = now;
            newest_sender_ = sender_;
            if (types::isOddlyLong(read_.orientation))
                odd_.add(topic_ + ": the quaternion's length is not 1: are its parts degrees, or of another order",
                         fmt::format("; its length is {:.4g}", glm::length(read_.orientation)));
            read_.orientation = glm::normalize(read_.orientation);
            std::swap(pose, read_);
            return true;
        }
        drops_.add(topic_ + ": " + diagnostic, detail);
    }
    more_ = true;
    return false;
}

}  // namespace insonify::dds
