#include "components/log/Writer.hpp"

#include "components/log/mcap/SampleWriter.hpp"
#include "components/log/pocolog/Writer.hpp"

namespace insonify::log {

void McapConfig::check(types::Diagnostics& diagnostics) const {
    std::map<std::string, std::string> streams_by_topic;
    ros::checkFrame("frame_id", frame_id, diagnostics);
    for (const auto& [name, stream] : streams) {
        if (stream.frame_id) ros::checkFrame("streams." + name + ".frame_id", *stream.frame_id, diagnostics);
        if (stream.child_frame_id)
            ros::checkFrame("streams." + name + ".child_frame_id", *stream.child_frame_id, diagnostics);
        if (!stream.topic) continue;
        const std::string topic = "/" + stream.topic->substr(stream.topic->starts_with('/'));
        const std::string path = "streams." + name + ".topic";
        if (!types::isRosName(topic))
            diagnostics.push_back({path, "is \"" + *stream.topic + "\"; must be words of letters, digits and _, none " +
                                             "beginning with a digit, as /auv/sonar"});
        else if (const auto [other, is_new] = streams_by_topic.emplace(topic, name); !is_new)
            diagnostics.push_back({path, "is " + topic + ", the topic of " + other->second + "; must be another"});
    }
}

std::unique_ptr<Writer> createLog(const std::filesystem::path& path, const McapConfig& mcap) {
    if (isMcap(path)) return std::make_unique<mcap::SampleWriter>(path, mcap);
    return std::make_unique<pocolog::Writer>(path);
}

bool isBesideAnotherBag(const std::filesystem::path& log) try {
    mcap::Bag{log};
    return false;
} catch (const types::ConfigError&) {
    return true;
}

}  // namespace insonify::log
