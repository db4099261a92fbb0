#include "components/viewer/Messages.hpp"

#include <algorithm>
#include <utility>

#include "components/ros/Cdr.hpp"

namespace insonify::viewer {

std::string topicOf(const std::string& source) {
    std::string topic = "/" + source;
    std::ranges::replace(topic, '.', '/');
    return topic;
}

Messages::Messages(ros::SonarOptions options, ros::WorldFrame world) {
    static_cast<ros::SonarOptions&>(options_) = std::move(options);
    options_.world_frame = world;
}

Bytes Messages::encode(const AnySample& sample) const {
    std::vector<char> bytes;
    const auto append = [&]<class T>(const T& shown) {
        typename ShownMessage<T>::type message;
        if constexpr (std::is_same_v<T, types::Snapshot>)
            ros::toMessage(shown.sonar, options_, message);
        else
            ros::toMessage(shown, options_, message);
        ros::encode(message, bytes);
    };
    std::visit([&](const auto& held) { append(*types::carriedSample(held)); }, sample);
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
