#include "components/viewer/Messages.hpp"

#include <algorithm>

#include "components/ros/Cdr.hpp"
#include "components/ros/FromSonar.hpp"
#include "components/ros/Pictures.hpp"
#include "components/ros/Poses.hpp"
#include "components/ros/Schema.hpp"

namespace insonify::viewer {
namespace {

template <class Message>
FoxgloveChannel channel(std::string topic) {
    return {std::move(topic), ros::shortName(Message::type_name), ros::schemaOf<Message>()};
}

template <class Message>
Bytes cdr(const Message& message) {
    std::vector<char> bytes;
    ros::encode(message, bytes);
    return bytesOf({bytes.begin(), bytes.end()});
}

types::Time stampOf(const types::Pose& pose) { return pose.time; }
template <class T>
types::Time stampOf(const std::shared_ptr<const T>& sample) {
    return sample ? sample->time : types::Time{};
}

}  // namespace

FoxgloveChannel channelOf(const std::string& source, SampleKind kind) {
    std::string topic = "/" + source;
    std::ranges::replace(topic, '.', '/');
    if (kind == SampleKind::Ping) return channel<ros::ProjectedSonarImage>(topic);
    if (kind == SampleKind::Image) return channel<ros::Image>(topic);
    return channel<ros::PoseStamped>(topic);
}

Bytes Messages::encode(const AnySample& sample) const {
    if (const auto* ping = std::get_if<types::SonarPtr>(&sample)) {
        ros::ProjectedSonarImage message;
        ros::convert(**ping, options_, message);
        return cdr(message);
    }
    if (const auto* picture = std::get_if<types::ImagePtr>(&sample)) {
        ros::Image message;
        ros::convert(**picture, options_.frame_id, message);
        return cdr(message);
    }
    const auto* snapshot = std::get_if<types::SnapshotPtr>(&sample);
    ros::PoseStamped message;
    ros::convert(snapshot ? (*snapshot)->sonar : std::get<types::Pose>(sample), world_, message);
    return cdr(message);
}

uint64_t nanosecondsOf(const AnySample& sample) {
    const types::Time stamp = std::visit([](const auto& held) { return stampOf(held); }, sample);
    return static_cast<uint64_t>(std::max<int64_t>(0, stamp.microseconds)) * 1000;
}

}  // namespace insonify::viewer
