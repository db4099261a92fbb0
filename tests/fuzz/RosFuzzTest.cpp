// Messages by DDS: CDR, which peers may fill with anything.
#include <gtest/gtest.h>

#include "components/ros/Cdr.hpp"
#include "components/ros/NodeMessages.hpp"
#include "components/ros/Pings.hpp"
#include "components/ros/Poses.hpp"
#include "components/ros/Samples.hpp"
#include "components/ros/Stamps.hpp"
#include "components/ros/TransformTree.hpp"
#include "tests/support/Fuzz.hpp"

namespace insonify::fuzz {
namespace {

/** Expects that what is read can be written, and read again. */
void writeAgain(const auto& message) {
    std::vector<char> again;
    ros::encode(message, again);
    std::remove_cvref_t<decltype(message)> second;
    ros::decode(std::span<const char>(again), second);
}

template <class Message, class Sample, class... Layout>
void readMessage(const Input& input, const Layout&... layout) try {
    Message message;
    ros::decode(input.span(), message);
    Sample sample;
    ros::convert(message, layout..., sample);
    writeAgain(message);
} catch (const ros::CdrError& error) {
    expectOurWords(error.what());
} catch (const std::invalid_argument& error) {
    expectOurWords(error.what());
}

void readRequest(const Input& input, auto request) try {
    ros::decode(input.span(), request);
    writeAgain(request);
} catch (const ros::CdrError& error) {
    expectOurWords(error.what());
}

/** Expects that chains between frames end for any message. */
void follow(const Input& input) try {
    ros::TFMessage message;
    ros::decode(input.span(), message);
    ros::TransformTree tree;
    const types::Time now = types::Time::fromSeconds(1e9);
    for (const bool is_static : {false, true})
        for (const ros::TransformStamped& transform : message.transforms)
            tree.add(transform, is_static, ros::fromRos(transform.header.stamp), now);
    for (const ros::TransformStamped& transform : message.transforms) {
        const auto found = tree.newest("map", transform.child_frame_id, now);
        if (found.placed) {
            EXPECT_NEAR(glm::length(found.placed->orientation), 1, 1e-9);
        }
    }
} catch (const ros::CdrError& error) {
    expectOurWords(error.what());
}

void readMessages(const Input& input) {
    follow(input);
    ros::forEachNodeMessage([&](const auto& request) { readRequest(input, request); });
    readMessage<ros::Odometry, types::Pose>(input, ros::WorldFrame::Enu);
    readMessage<ros::PoseStamped, types::Pose>(input, ros::WorldFrame::Ned);
    readMessage<ros::SonarDetections, types::SonarDetections>(input);
    for (const auto order : {ros::ImageOrder::RangeMajor, ros::ImageOrder::BeamMajor})
        readMessage<ros::ProjectedSonarImage, types::Sonar>(input, ros::ImageLayout{order, ros::SensorFrame::ZForward});
}

TEST(RosFuzzTest, EveryMessageIsASampleOrAnError) {
    push({"ros", "message", {std::string("\0\1\0\0", 4), "base_link", std::string("\1\0\0\0", 4)}, readMessages});
}

}  // namespace
}  // namespace insonify::fuzz
