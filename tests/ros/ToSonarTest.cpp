#include <gmock/gmock.h>

#include "components/ros/Pings.hpp"
#include "tests/ros/Samples.hpp"

namespace insonify::ros {
namespace {

std::string diagnosticOf(const ProjectedSonarImage& message) {
    try {
        types::Sonar ping;
        convert(message, {}, ping);
        return "";
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
}

TEST(ToSonarTest, AFloatImageGivesThePingBack) {
    for (const ImageOrder order : {ImageOrder::RangeMajor, ImageOrder::BeamMajor})
        for (const SensorFrame frame : {SensorFrame::ZForward, SensorFrame::XForward}) {
            SonarOptions options;
            options.dtype = ImageType::Float32;
            options.order = order;
            options.frame = frame;
            const types::Sonar ping = smallPing();
            ProjectedSonarImage message;
            convert(ping, options, message);
            types::Sonar again;
            convert(message, {order, frame}, again);
            EXPECT_TRUE(again.wellShaped());
            EXPECT_EQ(again.time, ping.time);
            EXPECT_EQ(again.bin_duration, ping.bin_duration);
            EXPECT_EQ(again.speed_of_sound, ping.speed_of_sound);
            EXPECT_FLOAT_EQ(static_cast<float>(again.beam_width.rad), 0.03f);
            EXPECT_FLOAT_EQ(static_cast<float>(again.beam_height.rad), 0.35f);
            EXPECT_THAT(again.bins, testing::Pointwise(testing::NanSensitiveFloatEq(), ping.bins));
            for (size_t beam = 0; beam < 2; ++beam)
                EXPECT_NEAR(again.bearings[beam].rad, ping.bearings[beam].rad, 1e-15);
        }
}

TEST(ToSonarTest, AnyBinDurationComesBackToTheMicrosecond) {
    SonarOptions options;
    for (int64_t duration = 1; duration < 100'000; duration = duration * 3 + 1)
        for (const uint32_t bins : {1u, 7u, 4000u}) {
            types::Sonar ping;
            ping.bin_duration = {duration};
            ping.speed_of_sound = 1481.7f;
            ping.resize(bins, 1);
            ProjectedSonarImage message;
            convert(ping, options, message);
            types::Sonar again;
            convert(message, {}, again);
            EXPECT_EQ(again.bin_duration.microseconds, duration);
        }
}

TEST(ToSonarTest, WholeNumbersAreSharesOfTheirGreatestValue) {
    ProjectedSonarImage message = smallImage();
    types::Sonar ping;
    convert(message, {}, ping);
    EXPECT_FLOAT_EQ(ping.bins[1], 3 / 255.0f);  // beam 0, bin 1 of 1 2 | 3 4 | 5 6
    message.image.dtype = SonarImageData::uint16;
    message.image.data.assign(12, 0xff);
    convert(message, {}, ping);
    EXPECT_THAT(ping.bins, testing::Each(1));
}

TEST(ToSonarTest, WhatIsNoPingIsRefused) {
    ProjectedSonarImage message = smallImage();
    message.image.data.pop_back();
    EXPECT_EQ(diagnosticOf(message), "sonar image: 5 bytes of data for 2 beams, 3 ranges and 1 bytes a number");
    message = smallImage();
    message.beam_directions.pop_back();
    EXPECT_EQ(diagnosticOf(message), "sonar image: 1 directions for 2 beams");
    message = smallImage();
    message.image.dtype = 7;
    EXPECT_EQ(diagnosticOf(message), "sonar image: dtype 7 is not read, only uint8, uint16, uint32, float32, float64");
    message = smallImage();
    message.ranges[1] = 1;
    EXPECT_EQ(diagnosticOf(message),
              "sonar image: range 1 is 1.000000 m; the ranges must be the centres of equal bins from 0 on");
    message = smallImage();
    message.ping_info.sound_speed = 0;
    EXPECT_EQ(diagnosticOf(message), "sonar image: a speed of sound of 0.000000 m/s");
}

TEST(ToSonarTest, CountsWhoseProductExceedsTheWordAreRefused) {
    ProjectedSonarImage message = smallImage();
    message.image.beam_count = 0xffffffff;
    EXPECT_EQ(diagnosticOf(message), "sonar image: 2 directions for 4294967295 beams");
}

}  // namespace
}  // namespace insonify::ros
