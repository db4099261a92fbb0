#include "components/viewer/Messages.hpp"

#include <algorithm>
#include <utility>

#include "components/ros/Cdr.hpp"
#include "types/SonarScan.hpp"

namespace insonify::viewer {

std::string topicOf(const std::string& source) {
    std::string topic = "/" + source;
    std::ranges::replace(topic, '.', '/');
    return topic;
}

namespace {

/** Returns the transform of a frame in another, from a pose. */
foxglove::FrameTransforms transformOf(const types::Pose& pose, const std::string& child,
                                      const ros::MessageOptions& options) {
    ros::PoseStamped placed;
    ros::toMessage(pose, options, placed);
    const auto& [position, orientation] = placed.pose;
    return {{{placed.header.stamp, placed.header.frame_id, child, {position.x, position.y, position.z}, orientation}}};
}

const types::Sonar& pingOf(const types::Sonar& ping) { return ping; }
types::Sonar pingOf(const auto& beams) { return types::toSonar(beams); }

}  // namespace

Messages::Messages(ros::SonarOptions options, ros::WorldFrame world, size_t max_triangles)
    : scene_(world, max_triangles) {
    static_cast<ros::SonarOptions&>(options_) = std::move(options);
    options_.world_frame = world;
}

template <class T>
void Messages::append(const T& sample, Form form, std::vector<char>& bytes) {
    if constexpr (is_ping<T>) {
        if (form == Form::Picture) {
            ros::Image picture;
            picture_.draw(pingOf(sample), options_, picture);
            return ros::encode(picture, bytes);
        }
        if (form == Form::Points) {
            ros::PointCloud2 points;
            ros::toMessage(sample, options_, points);
            return ros::encode(points, bytes);
        }
    }
    if constexpr (std::is_same_v<T, types::Pose>) {
        if (form == Form::Transforms) return ros::encode(transformOf(sample, sample.source_frame, options_), bytes);
    }
    typename ShownMessage<T>::type message;
    if constexpr (std::is_same_v<T, types::Snapshot>) {
        if (form == Form::Transforms) return ros::encode(transformOf(sample.sonar, options_.frame_id, options_), bytes);
        ros::toMessage(sample.sonar, options_, message);
    } else {
        ros::toMessage(sample, options_, message);
    }
    ros::encode(message, bytes);
}

Bytes Messages::encode(const AnySample& sample, Form form) {
    std::vector<char> bytes;
    std::visit([&](const auto& held) { append(*types::carriedSample(held), form, bytes); }, sample);
    return bytesOf({bytes.begin(), bytes.end()});
}

types::Time stampOf(const AnySample& sample, types::Time otherwise) {
    return std::visit(
        [&](const auto& held) {
            const auto* const shown = types::carriedSample(held);
            return shown ? types::sampleTime(*shown, otherwise) : otherwise;
        },
        sample);
}

}  // namespace insonify::viewer
