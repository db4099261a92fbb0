#pragma once
#include "components/log/Copy.hpp"
#include "components/log/Files.hpp"
#include "components/log/mcap/SampleWriter.hpp"
#include "tests/support/Folder.hpp"

namespace insonify::log::mcap {

/** A ping with beam 0 and bins 1, 2, 3...; the last bin is NaN. */
inline types::Sonar smallPing(int64_t time) {
    types::Sonar ping;
    ping.time = {time};
    ping.bin_duration = {500};
    ping.speed_of_sound = 1500;
    ping.beam_width = {0.03};
    ping.bearings = {{0.5}, {-0.25}};
    ping.beam_count = 2;
    ping.bin_count = 3;
    ping.bins = {1, 2, 3, 4, 5, std::numeric_limits<float>::quiet_NaN()};
    return ping;
}

inline types::Pose smallPose(int64_t time) {
    types::Pose pose;
    pose.time = {time};
    pose.source_frame = "body";
    pose.target_frame = "world";
    pose.position = {0.1, -0.2, 0.3};
    pose.orientation = {0.5, -0.5, 0.5, 0.5};
    return pose;
}

/** This frame keeps every bit of an orientation. */
inline McapConfig asItIs() {
    McapConfig config;
    config.world_frame = ros::WorldFrame::AsIs;
    return config;
}

/** Three pings and two poses, a ping last; each received 10 s after its time. */
inline std::vector<char> smallFile(const std::filesystem::path& path, const McapConfig& config = asItIs()) {
    SampleWriter log(path, config);
    const Metadata metadata = {{"insonify_seed", "7"}, {"insonify_deployment", "tasks:\n  a: \"b\"\n"}};
    const size_t ping = log.addStream<types::Sonar>("sonar.ping", metadata);
    const size_t pose = log.addStream<types::Pose>("vehicle.pose", metadata);
    for (int64_t i = 1; i <= 3; ++i) {
        const types::Time received{i + 10'000'000};
        if (i < 3) log.write(pose, received, smallPose(i));
        log.write(ping, received, smallPing(i));
    }
    log.close();
    return toBytes(path);
}

}  // namespace insonify::log::mcap
