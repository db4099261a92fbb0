#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "components/viewer/PingPicture.hpp"

namespace insonify::viewer {
namespace {

struct Message {
    nlohmann::json json;
    std::string levels;
    uint8_t level(size_t i) const { return static_cast<uint8_t>(levels.at(i)); }
};

Message takenApart(const std::string& bytes) {
    uint32_t head[2];
    std::memcpy(head, bytes.data(), sizeof head);
    EXPECT_EQ(head[0], ping_kind);
    EXPECT_EQ(head[1] % 4, 0u);
    return {nlohmann::json::parse(bytes.substr(8, head[1])), bytes.substr(8 + head[1])};
}

types::Sonar makePing(uint32_t beams, uint32_t bins) {
    types::Sonar ping;
    ping.time = {5};
    ping.bin_duration = {100};
    ping.speed_of_sound = 1500;
    ping.resize(bins, beams);
    for (types::Angle& bearing : ping.bearings) bearing.rad = 0.25;
    return ping;
}

TEST(PingPictureTest, ALevelIsWithinHalfAStepOfTheBin) {
    types::Sonar ping = makePing(1, 200);
    for (size_t i = 0; i < 200; ++i) ping.bins[i] = static_cast<float>(std::pow(10, -0.05 * static_cast<double>(i)));
    const Message message = takenApart(PingPicture(ros::BinScale::Linear).encode(ping, {"s", 0.5, 7}));
    EXPECT_NEAR(message.json["top_db"].get<double>(), 0, 0.02);
    for (size_t i = 0; i < 200; ++i)
        EXPECT_NEAR(message.json["top_db"].get<double>() - (255 - message.level(i)) * 0.4,
                    -0.5 * static_cast<double>(i), 0.24)
            << i;
    EXPECT_EQ(message.json["count"], 7);
    EXPECT_EQ(message.json["latency_s"], 0.5);
    EXPECT_NEAR(message.json["bin_m"].get<double>(), 0.15, 1e-12);
    EXPECT_EQ(message.json["bearings"], nlohmann::json::parse("[0.25]"));
}

TEST(PingPictureTest, NoEchoIsZero) {
    types::Sonar ping = makePing(2, 4);
    const float infinite = std::numeric_limits<float>::infinity();
    ping.bins = {NAN, 0, -1, infinite, 1, 1e-38f, -infinite, -0.0f};
    const Message message = takenApart(PingPicture(ros::BinScale::Linear).encode(ping, {}));
    EXPECT_EQ(message.levels, std::string("\0\0\0\0\xff\0\0\0", 8));
}

TEST(PingPictureTest, DecibelsAreUnchanged) {
    types::Sonar ping = makePing(1, 4);
    ping.bins = {-20, -24, -3000, NAN};
    const Message message = takenApart(PingPicture(ros::BinScale::Decibel).encode(ping, {}));
    EXPECT_EQ(message.levels, std::string("\xff\xf5\0\0", 4));
    EXPECT_EQ(message.json["top_db"], -20);
}

TEST(PingPictureTest, TheStrongestOfMergedBinsCounts) {
    types::Sonar ping = makePing(2, 10001);
    std::ranges::fill(ping.bins, 0.0f);
    ping.bins[10001 + 4] = 1;
    const Message message = takenApart(PingPicture(ros::BinScale::Linear).encode(ping, {}));
    EXPECT_EQ(message.json["bins"], 3334);
    EXPECT_NEAR(message.json["bin_m"].get<double>(), 0.45, 1e-12);
    EXPECT_EQ(message.levels.find('\xff'), size_t{3334 + 1});
}

TEST(PingPictureTest, BeamsAreFromStarboardToPortWithEdgesWithoutUnknownBearings) {
    types::Sonar ping = makePing(4, 1);
    ping.bins = {0.1f, 1, 0.01f, 10};
    ping.bearings = {types::Angle::fromDeg(-175), types::Angle::fromDeg(175), types::Angle{},
                     types::Angle::fromDeg(150)};
    ping.beam_width = types::Angle::fromDeg(10);
    const Message message = takenApart(PingPicture(ros::BinScale::Linear).encode(ping, {}));
    EXPECT_EQ(message.json["beams"], 3);
    EXPECT_EQ(message.levels, std::string("\xff\xe6\xcd"));
    const double edges_deg[] = {145, 155, 170, 180, 180, 190};
    ASSERT_EQ(message.json["edges"].size(), 6u);
    for (size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(types::degrees(message.json["edges"][i].get<double>()), edges_deg[i], 1e-9) << i;
    EXPECT_NEAR(types::degrees(message.json["bearings"][2].get<double>()), 185, 1e-9);
}

TEST(PingPictureTest, EncodesAPingWithoutEchoOrBins) {
    types::Sonar silent = makePing(1, 3);
    EXPECT_EQ(takenApart(PingPicture(ros::BinScale::Linear).encode(silent, {})).levels, std::string(3, '\0'));
    EXPECT_EQ(takenApart(PingPicture(ros::BinScale::Linear).encode(makePing(0, 0), {})).levels, "");
}

}  // namespace
}  // namespace insonify::viewer
