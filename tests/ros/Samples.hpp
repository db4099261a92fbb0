#pragma once

#include "components/ros/Samples.hpp"
#include "types/samples/Pose.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::ros {

/** Two beams (0.5 rad to port, 0.25 to starboard) of three bins of 0.75 m: 1, 9, 100 and 0.02, NaN, 1000. */
inline types::Sonar smallPing() {
    types::Sonar ping;
    ping.time = {1'700'000'000'123'456};
    ping.bin_duration = {500};
    ping.speed_of_sound = 1500;
    ping.beam_width = {0.03};
    ping.beam_height = {0.35};
    ping.bearings = {{0.5}, {-0.25}};
    ping.beam_count = 2;
    ping.bin_count = 3;
    ping.bins = {1, 9, 100, 0.02f, std::numeric_limits<float>::quiet_NaN(), 1000};
    return ping;
}

/** At x 3 north, y 2 west, z -5, turned 90 degrees to port (so that it looks west), all values known. */
inline types::Pose smallPose() {
    types::Pose pose;
    pose.time = {2'000'001};
    pose.source_frame = "body";
    pose.target_frame = "world";
    pose.position = {3, 2, -5};
    pose.orientation = glm::angleAxis(types::radians(90), glm::dvec3(0, 0, 1));
    pose.cov_position = {{1, 0.1, 0}, {0.1, 2, 0}, {0, 0, 3}};
    pose.cov_orientation = {{0.01, 0, 0}, {0, 0.02, 0}, {0, 0, 0.03}};
    pose.velocity = {0.5, 1.5, -0.25};
    pose.cov_velocity = {{4, 0, 0}, {0, 5, 0}, {0, 0, 6}};
    pose.angular_velocity = {0.1, 0.2, 0.3};
    pose.cov_angular_velocity = {{7, 0, 0}, {0, 8, 0}, {0, 0, 9}};
    return pose;
}

inline ProjectedSonarImage smallImage() {
    ProjectedSonarImage image;
    image.header.stamp = {12, 34};
    image.header.frame_id = "sonar";
    image.ping_info.sound_speed = 1500;
    image.ping_info.tx_beamwidths = {0.35f};
    image.ping_info.rx_beamwidths = {0.01f, 0.02f};
    image.beam_directions = {{0, -0.5, 0.75}, {0.125, 0.25, 1}};
    image.ranges = {0.25f, 0.75f, 1.25f};
    image.image.beam_count = 2;
    image.image.data = {1, 2, 3, 4, 5, 6};
    return image;
}

}  // namespace insonify::ros
