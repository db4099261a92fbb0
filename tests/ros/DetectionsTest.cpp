// Detections of a sonar as marine_acoustic_msgs/SonarDetections: every field by the comments of its definition.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "components/ros/Cdr.hpp"
#include "components/ros/Pings.hpp"
#include "components/ros/Schema.hpp"
#include "tests/ros/Samples.hpp"
#include "tests/support/Draw.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::ros {
namespace {

using testing::ElementsAre, testing::FloatEq, testing::HasSubstr, testing::IsEmpty, testing::IsNan;

/** A beam 0.5 rad to port and 0.25 up, one 0.25 to starboard and 0.125 down, and one ahead without a return. */
types::SonarDetections smallDetections() {
    types::SonarDetections detections;
    detections.copyPing(smallPing());
    detections.add({0.5}, {0.25}, 15, 2);
    detections.add({-0.25}, {-0.125}, 7.5, 0.5f);
    detections.add({0}, {0}, types::SonarDetections::no_return, 3);
    return detections;
}

SonarDetections makeMessage(const auto& sample, const SonarOptions& options = {}) {
    SonarDetections message;
    convert(sample, options, message);
    return message;
}

TEST(DetectionsTest, EveryFieldIsThatOfTheDefinition) {
    SonarOptions options;
    options.frequency_khz = 400;
    options.frame_id = "multibeam";
    const SonarDetections message = makeMessage(smallDetections(), options);
    EXPECT_EQ(message.header, (Header{{1'700'000'000, 123'456'000}, "multibeam"})) << "when the ping was transmitted";
    EXPECT_EQ(message.ping_info, (PingInfo{400e3f, 1500, {0.35f}, {0.03f}}))
        << "Hz, m/s; the transmit beam is narrow along the track, the receive beams across";
    EXPECT_THAT(message.flags, ElementsAre(DetectionFlag{0}, DetectionFlag{0}, DetectionFlag{1}))
        << "0: good, 1: flagged as bad by the sonar";
    EXPECT_THAT(message.two_way_travel_times, ElementsAre(FloatEq(0.02f), FloatEq(0.01f), IsNan())) << "seconds";
    EXPECT_THAT(message.tx_delays, ElementsAre(0, 0, 0)) << "all beams transmit at the stamp";
    EXPECT_THAT(message.intensities, ElementsAre(2, 0.5f, 0));
    EXPECT_THAT(message.tx_angles, ElementsAre(0.25f, -0.125f, 0)) << "+ forward: up, for a sonar that looks down";
    EXPECT_THAT(message.rx_angles, ElementsAre(-0.5f, 0.25f, 0)) << "+ to starboard, - to port";
}

/** The direction by both angles is that of the beam: x forward, y to starboard, z down for a sonar that looks down. */
TEST(DetectionsTest, BothAnglesGiveTheDirectionOfTheBeam) {
    test::Draw draw(1);
    for (int i = 0; i < 100; ++i) {
        const double bearing = draw.between(-1.5, 1.5), elevation = draw.between(-1.5, 1.5);
        types::SonarDetections detections;
        detections.speed_of_sound = 1500;
        detections.add({bearing}, {elevation}, 10, 1);
        const SonarDetections message = makeMessage(detections);
        const auto tx = static_cast<double>(message.tx_angles[0]), rx = static_cast<double>(message.rx_angles[0]);
        // In the sonar's frame, x ahead, y to port, z up; looking down these are down, to port and forward.
        EXPECT_NEAR(std::sin(tx), std::sin(elevation), 1e-6) << "forward";
        EXPECT_NEAR(std::cos(tx) * std::sin(rx), -std::cos(elevation) * std::sin(bearing), 1e-6) << "starboard";
        EXPECT_NEAR(std::cos(tx) * std::cos(rx), std::cos(elevation) * std::cos(bearing), 1e-6) << "down";
    }
}

TEST(DetectionsTest, RandomDetectionsAreReadBackFromBytes) {
    const test::Seeds seeds(100);
    for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
        SCOPED_TRACE(seed);
        test::Draw draw(seed);
        types::SonarDetections sent;
        sent.time = {static_cast<int64_t>(draw.between(0, 2e15))};
        sent.speed_of_sound = static_cast<float>(draw.between(1400, 1600));
        if (!draw.once(3)) sent.beam_width = {draw.between(0.001, 1)};
        if (!draw.once(3)) sent.beam_height = {draw.between(0.001, 1)};
        for (int beams = draw.upTo(300); beams > 0; --beams)
            sent.add({draw.between(-3.1, 3.1)}, {draw.between(-1.5, 1.5)},
                     draw.once(5) ? types::SonarDetections::no_return : draw.between(0.01, 500),
                     static_cast<float>(draw.between(0, 1)));
        std::vector<char> bytes;
        encode(makeMessage(sent), bytes);
        SonarDetections message;
        decode(bytes, message);
        types::SonarDetections read;
        read.add({9}, {9}, 9, 9);  // is replaced
        convert(message, read);
        ASSERT_EQ(read.bearings.size(), sent.bearings.size());
        EXPECT_EQ(read.diagnostic(), nullptr);
        EXPECT_EQ(read.time, sent.time);
        EXPECT_EQ(read.speed_of_sound, sent.speed_of_sound);
        EXPECT_EQ(read.elevations, sent.elevations);
        EXPECT_EQ(read.intensities, sent.intensities);
        EXPECT_EQ(read.beam_width.isUnknown(), sent.beam_width.isUnknown());
        EXPECT_EQ(read.beam_height.isUnknown(), sent.beam_height.isUnknown());
        for (size_t k = 0; k < sent.bearings.size(); ++k) {
            EXPECT_NEAR(read.bearings[k].rad, sent.bearings[k].rad, 2e-7);
            const float time = sent.travel_times[k];
            EXPECT_TRUE(std::isnan(time) ? std::isnan(read.travel_times[k]) : read.travel_times[k] == time);
        }
    }
}

TEST(DetectionsTest, ReadsDetectionsOfOtherSonars) {
    SonarDetections message;
    message.ping_info.sound_speed = 1480;
    message.two_way_travel_times = {0.01f, 0.02f};
    message.rx_angles = {0.5f, -0.5f};
    types::SonarDetections read;
    convert(message, read);
    EXPECT_THAT(read.travel_times, ElementsAre(0.01f, 0.02f)) << "without flags all beams are good";
    EXPECT_THAT(read.elevations, ElementsAre(0, 0));
    EXPECT_THAT(read.intensities, ElementsAre(0, 0));
    EXPECT_EQ(read.bearings[0].rad, -0.5) << "to starboard";
    EXPECT_TRUE(read.beam_width.isUnknown());
    message.flags = {{DetectionFlag::bad_filter}, {DetectionFlag::ok}};
    convert(message, read);
    EXPECT_THAT(read.travel_times, ElementsAre(IsNan(), 0.02f)) << "flagged for any reason";
    const auto refusal = [&](auto change) {
        SonarDetections wrong = message;
        change(wrong);
        return test::computeError<std::invalid_argument>([&] { convert(wrong, read); });
    };
    EXPECT_THAT(refusal([](auto& m) { m.rx_angles.clear(); }),
                HasSubstr("sonar detections: 0 rx_angles for 2 travel times"));
    EXPECT_THAT(refusal([](auto& m) { m.flags.pop_back(); }), HasSubstr("1 flags for 2 travel times"));
    EXPECT_THAT(refusal([](auto& m) { m.intensities = {1, 2, 3}; }), HasSubstr("3 intensities for 2 travel times"));
    EXPECT_THAT(refusal([](auto& m) { m.tx_angles = {1}; }), HasSubstr("1 tx_angles for 2 travel times"));
    types::SonarDetections uneven = smallDetections();
    uneven.elevations.pop_back();
    EXPECT_THAT(test::computeError<std::invalid_argument>([&] { makeMessage(uneven); }),
                HasSubstr("has other numbers of detections than bearings"));
}

TEST(DetectionsTest, APingBecomesTheTravelTimesOfItsFirstReturns) {
    types::Sonar ping = smallPing();
    ping.bins = {1.5f, 10, 100, 0.01f, 0.02f, 0.5f};  // 20 dB below the strongest: 1
    ping.timestamps = {ping.time + types::Time{4000}, ping.time};
    const SonarDetections message = makeMessage(ping);
    EXPECT_THAT(message.two_way_travel_times, ElementsAre(FloatEq(0.0005f), IsNan())) << "0.375 m at 1500 m/s";
    EXPECT_THAT(message.flags, ElementsAre(DetectionFlag{0}, DetectionFlag{2})) << "2: bad by a filter";
    EXPECT_THAT(message.intensities, ElementsAre(1.5f, 0));
    EXPECT_THAT(message.tx_angles, ElementsAre(0, 0));
    EXPECT_THAT(message.rx_angles, ElementsAre(-0.5f, 0.25f));
    EXPECT_THAT(message.tx_delays, ElementsAre(FloatEq(0.004f), 0)) << "of beams with their own stamps";
}

TEST(DetectionsTest, TheDefinitionIsThatOfThePackage) {
    EXPECT_THAT(describeSchema<SonarDetections>(),
                testing::StartsWith("std_msgs/Header header\nmarine_acoustic_msgs/PingInfo ping_info\n"
                                    "marine_acoustic_msgs/DetectionFlag[] flags\nfloat32[] two_way_travel_times\n"
                                    "float32[] tx_delays\nfloat32[] intensities\nfloat32[] tx_angles\n"
                                    "float32[] rx_angles\n"));
}

}  // namespace
}  // namespace insonify::ros
