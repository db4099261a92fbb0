#include "components/dds/Publication.hpp"

namespace insonify::dds {

TopicOptions optionsOf(const PublisherConfig& config, const TopicOut& topic) {
    TopicOptions options{{}, config.world_frame_id, topic.child_frame_id};
    static_cast<ros::SonarOptions&>(options.messages) = topic.sonar;
    options.messages.world_frame = config.node.world_frame;
    if (topic.sonar.frame_id.empty())
        options.messages.frame_id = config.frame_id;
    else
        options.world_frame_id = topic.sonar.frame_id;
    return options;
}

void nameFrame(std::string& frame, const std::optional<std::string>& given, const char* usual) {
    if (given) frame = *given;
    if (frame.empty()) frame = usual;
}

Writer writerOf(Node& node, const PublisherConfig& config, const TopicOut& topic) {
    const Quality quality{.reliability = config.reliability, .depth = config.depth};
    return withMessage(topic.type, [&]<class Message>(std::type_identity<Message>) {
        return Writer(node, ddsTopic(topic.topic), Message::type_name, Message::type_hash, quality);
    });
}

}  // namespace insonify::dds
