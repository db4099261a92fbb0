#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "components/ros/Pings.hpp"
#include "tests/ros/Samples.hpp"
#include "tests/support/Fans.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::ros {
namespace {

using testing::ElementsAre;
using testing::FloatEq;
using testing::FloatNear;
using testing::IsNan;

/** Returns options for images of eight bits. */
SonarOptions levels() {
    SonarOptions options;
    options.dtype = ImageType::Uint8;
    return options;
}

template <class Message>
Message makeMessage(const types::Sonar& ping, const SonarOptions& options = {}) {
    Message message;
    convert(ping, options, message);
    return message;
}

std::vector<float> toFloats(const std::vector<uint8_t>& bytes) {
    std::vector<float> numbers(bytes.size() / sizeof(float));
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
    return numbers;
}

std::string findDiagnostic(const types::Sonar& ping) {
    return test::computeError<std::exception>([&] { makeMessage<LaserScan>(ping); });
}

std::string findDiagnostic(const ProjectedSonarImage& message) {
    types::Sonar ping;
    return test::computeError<std::invalid_argument>([&] { convert(message, {}, ping); });
}

TEST(PingsTest, AnImageHasTimeSoundSpeedAndBeamWidths) {
    SonarOptions options;
    options.frequency_khz = 750;
    const auto image = makeMessage<ProjectedSonarImage>(smallPing(), options);
    EXPECT_EQ(image.header, (Header{{1'700'000'000, 123'456'000}, "sonar"}));
    EXPECT_EQ(image.ping_info, (PingInfo{750e3f, 1500, {0.35f}, {0.03f}}));
    EXPECT_THAT(image.ranges, ElementsAre(FloatEq(0.375f), FloatEq(1.125f), FloatEq(1.875f)));
}

TEST(PingsTest, DirectionsHaveZAheadAndYToStarboardOrXAheadAndYToPort) {
    SonarOptions options;
    const auto z_forward = makeMessage<ProjectedSonarImage>(smallPing(), options).beam_directions;
    EXPECT_THAT(z_forward,
                ElementsAre(Vector3{0, -std::sin(0.5), std::cos(0.5)}, Vector3{0, std::sin(0.25), std::cos(0.25)}));
    options.frame = SensorFrame::XForward;
    EXPECT_EQ(makeMessage<ProjectedSonarImage>(smallPing(), options).beam_directions[0],
              (Vector3{std::cos(0.5), std::sin(0.5), 0}));
}

TEST(PingsTest, EightBitsAreDecibelsBelowTheStrongestEcho) {
    // levels 0, 9.5, 20 and -17, none, 30 dB; 30 dB is 255 and -30 dB is 0: 4.25 a dB
    EXPECT_THAT(makeMessage<ProjectedSonarImage>(smallPing(), levels()).image.data,
                ElementsAre(128, 55, 168, 0, 213, 255));
}

TEST(PingsTest, AFixedReferenceClipsStrongerEchoes) {
    SonarOptions options = levels();
    options.order = ImageOrder::BeamMajor;
    options.reference_db = 10;
    options.dynamic_range_db = 20;
    EXPECT_THAT(makeMessage<ProjectedSonarImage>(smallPing(), options).image.data,
                ElementsAre(128, 249, 255, 0, 0, 255));
    options.scale = BinScale::Decibel;  // the bins are then the levels
    EXPECT_THAT(makeMessage<ProjectedSonarImage>(smallPing(), options).image.data,
                ElementsAre(140, 242, 255, 128, 0, 255));
}

TEST(PingsTest, EightBitsAreTheRoundedLevelOfEveryBin) {
    types::Sonar ping;
    ping.resize(20000, 1);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> exponent(-37, 38);
    for (float& bin : ping.bins) bin = std::pow(10.0f, exponent(random));
    ping.bins.front() = std::numeric_limits<float>::infinity();
    for (const auto& [reference, range] :
         {std::pair{0.0, 60.0}, {-120.0, 300.0}, {35.5, 1.0}, {-3000.0, 60.0}, {3000.0, 90.0}}) {
        SonarOptions options = levels();
        options.reference_db = reference;
        options.dynamic_range_db = range;
        const auto got = makeMessage<ProjectedSonarImage>(ping, options).image.data;
        for (size_t i = 0; i < ping.bins.size(); ++i) {
            const double exact = 255 + (10 * std::log10(static_cast<double>(ping.bins[i])) - reference) * 255 / range;
            ASSERT_NEAR(got[i], std::clamp(exact, 0.0, 255.0), 0.5 + 1e-4) << ping.bins[i] << " over " << reference;
        }
    }
}

TEST(PingsTest, APingWithoutEchoIsBlack) {
    types::Sonar ping = smallPing();
    ping.bins.assign(6, 0);
    EXPECT_THAT(makeMessage<ProjectedSonarImage>(ping, levels()).image.data, testing::Each(0));
    EXPECT_EQ(makeMessage<PointCloud2>(ping).width, 0u);
    ping.bins.assign(6, -3000);  // no echo, in decibels
    SonarOptions options = levels();
    options.scale = BinScale::Decibel;
    EXPECT_THAT(makeMessage<ProjectedSonarImage>(ping, options).image.data, testing::Each(0));
    EXPECT_EQ(makeMessage<PointCloud2>(ping, options).width, 0u);
    EXPECT_THAT(makeMessage<SonarRanges>(ping, options).ranges, testing::Each(IsNan()));
}

TEST(PingsTest, FloatsAreTheBinsUnchangedInBothOrders) {
    SonarOptions options;  // float32, in logs and on the wire
    EXPECT_THAT(toFloats(makeMessage<ProjectedSonarImage>(smallPing(), options).image.data),
                ElementsAre(1, 0.02f, 9, IsNan(), 100, 1000));
    options.order = ImageOrder::BeamMajor;
    const auto image = makeMessage<ProjectedSonarImage>(smallPing(), options).image;
    EXPECT_THAT(toFloats(image.data), ElementsAre(1, 9, 100, 0.02f, IsNan(), 1000));
    EXPECT_EQ(image.dtype, SonarImageData::float32);
    EXPECT_EQ(image.beam_count, 2u);
}

TEST(PingsTest, ARawImageHasTheSampleRateOfTheBinWidth) {
    types::Sonar ping = smallPing();
    ping.timestamps = {ping.time, ping.time + types::Time{250}};
    const auto raw = makeMessage<RawSonarImage>(ping, levels());
    EXPECT_FLOAT_EQ(1500 / (2 * raw.sample_rate), 0.75f);
    EXPECT_EQ(raw.samples_per_beam, 3u);
    EXPECT_THAT(raw.tx_delays, ElementsAre(0, FloatEq(250e-6f)));
    EXPECT_THAT(raw.rx_angles, ElementsAre(-0.5f, 0.25f));  // to starboard
    EXPECT_THAT(raw.image.data, ElementsAre(128, 55, 168, 0, 213, 255));
}

TEST(PingsTest, RangesAreTheFirstBinsAboveTheThreshold) {
    types::Sonar ping = smallPing();
    ping.bins = {1.5f, 10, 100, 0.01f, 0.02f, 0.5f};  // 20 dB below the strongest: 1
    const auto ranges = makeMessage<SonarRanges>(ping);
    EXPECT_THAT(ranges.ranges, ElementsAre(FloatEq(0.375f), IsNan()));
    EXPECT_THAT(ranges.flags, ElementsAre(DetectionFlag{0}, DetectionFlag{2}));
    EXPECT_THAT(ranges.intensities, ElementsAre(1.5f, 0));
}

TEST(PingsTest, ACloudHasEveryBinAboveTheThreshold) {
    const auto cloud = makeMessage<PointCloud2>(smallPing());  // 100 and 1000 are; x ahead for any `frame`
    ASSERT_EQ(cloud.width, 2u);
    EXPECT_EQ(cloud.point_step, 16u);
    EXPECT_EQ(cloud.fields[3], (PointField{"intensity", 12, PointField::float32, 1}));
    const auto near = [](double value) { return FloatNear(static_cast<float>(value), 1e-6f); };
    EXPECT_THAT(toFloats(cloud.data),
                ElementsAre(near(1.875 * std::cos(0.5)), near(1.875 * std::sin(0.5)), 0, 100,
                            near(1.875 * std::cos(0.25)), near(-1.875 * std::sin(0.25)), 0, 1000));
}

TEST(PingsTest, AScanHasItsRaysAtTheBeamsFromStarboardToPort) {
    SonarOptions options;
    options.threshold_db = -45;  // -15 dB: all but 0.02 and NaN
    const auto scan = makeMessage<LaserScan>(smallPing(), options);
    EXPECT_FLOAT_EQ(scan.angle_min, -0.25f);
    EXPECT_FLOAT_EQ(scan.angle_increment, 0.75f);
    EXPECT_FLOAT_EQ(scan.angle_max, 0.5f);
    EXPECT_THAT(scan.ranges, ElementsAre(FloatEq(1.875f), FloatEq(0.375f)));
    EXPECT_FLOAT_EQ(scan.range_max, 2.25f);
    types::Sonar silent = smallPing();
    silent.bins.assign(6, 0);
    EXPECT_THAT(makeMessage<LaserScan>(silent, options).ranges, testing::Each(std::numeric_limits<float>::infinity()));
}

TEST(PingsTest, AScanOfUnorderedBeamsHasNanInGapsAndContinuesAcrossTheSeam) {
    types::Sonar ping = test::makePing(5, 4);
    const double bearings_deg[] = {-170, 155, 175, 160, -175};
    for (uint32_t beam = 0; beam < 5; ++beam) {
        ping.bearings[beam] = types::Angle::fromDeg(bearings_deg[beam]);
        std::fill_n(&ping.bins[beam * 4], 4, 0.0f);
        if (beam < 4) ping.bins[beam * 4 + beam] = 1;
    }
    const auto scan = makeMessage<LaserScan>(ping);
    EXPECT_NEAR(scan.angle_min, types::radians(155), 1e-6);
    EXPECT_NEAR(scan.angle_increment, types::radians(5), 1e-6);
    EXPECT_NEAR(scan.angle_max, types::radians(190), 1e-6);
    constexpr float none = std::numeric_limits<float>::infinity();
    EXPECT_THAT(scan.ranges, ElementsAre(FloatEq(0.15f), FloatEq(0.35f), IsNan(), IsNan(), FloatEq(0.25f), IsNan(),
                                         none, FloatEq(0.05f)));
    EXPECT_THAT(scan.intensities, ElementsAre(1, 1, 0, 0, 1, 0, 0, 1));
}

TEST(PingsTest, AScanOfARandomFanHasEachBeamAtItsAngleOrIsRefused) {
    size_t sent = 0;
    for (const test::RandomFan& fan : test::randomFans(5, 8)) {
        const types::Sonar& ping = fan.ping;
        SonarOptions options;
        options.threshold_db = -200;
        LaserScan scan, ascending;
        try {
            convert(ping, options, scan);
        } catch (const std::invalid_argument& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr("not at equal angles")) << fan.name;
            EXPECT_THROW(convert(fan.ascending, options, ascending), std::invalid_argument) << fan.name;
            continue;
        }
        ++sent;
        convert(fan.ascending, options, ascending);
        EXPECT_TRUE(scan.ranges.size() == ascending.ranges.size() && scan.angle_min == ascending.angle_min &&
                    scan.angle_increment == ascending.angle_increment);
        EXPECT_EQ(scan.intensities, ascending.intensities) << fan.name;
        EXPECT_GE(scan.angle_increment, 0) << fan.name;
        for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
            EXPECT_EQ(std::ranges::count(scan.intensities, ping.bins[size_t{beam} * ping.bin_count]), 1) << fan.name;
        for (size_t ray = 0; ray < scan.ranges.size(); ++ray) {
            if (std::isnan(scan.ranges[ray])) continue;
            const double angle = static_cast<double>(scan.angle_min + static_cast<float>(ray) * scan.angle_increment);
            uint32_t beam = 0;
            while (ping.bins[size_t{beam} * ping.bin_count] != scan.intensities[ray]) ++beam;
            EXPECT_LT(test::apart(ping.bearings[beam].rad, angle), 1e-5) << fan.name;
        }
    }
    EXPECT_GE(sent, 20u) << "descending, shuffled, across the seam, all around, one";
}

TEST(PingsTest, RefusesPingsThatAMessageCannotRepresent) {
    types::Sonar ping = smallPing();
    ping.bins.pop_back();
    EXPECT_EQ(findDiagnostic(ping), "the lists of the ping are not as long as its counts say");
    ping = smallPing();
    ping.resize(3, 3);
    ping.bearings[2] = {-0.6};
    EXPECT_EQ(findDiagnostic(ping),
              "the beams are not at equal angles from one another, nor at multiples of the smallest angle, as a "
              "LaserScan needs; send them as PointCloud2 or SonarRanges");
    ping = smallPing();
    ping.time = types::Time::fromSeconds(3e9);
    EXPECT_EQ(findDiagnostic(ping), "ROS holds no time of 3000000000 s: from -2147483648 s to 2147483647 s");
}

TEST(PingsTest, RestoresAPingFromAFloatImage) {
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

TEST(PingsTest, RestoresAnyBinDurationToTheMicrosecond) {
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

TEST(PingsTest, DividesIntegersByTheirMaxValue) {
    ProjectedSonarImage message = smallImage();
    types::Sonar ping;
    convert(message, {}, ping);
    EXPECT_FLOAT_EQ(ping.bins[1], 3 / 255.0f);  // beam 0, bin 1 of 1 2 | 3 4 | 5 6
    message.image.dtype = SonarImageData::uint16;
    message.image.data.assign(12, 0xff);
    convert(message, {}, ping);
    EXPECT_THAT(ping.bins, testing::Each(1));
}

TEST(PingsTest, RefusesInvalidImages) {
    ProjectedSonarImage message = smallImage();
    message.image.data.pop_back();
    EXPECT_EQ(findDiagnostic(message), "sonar image: 5 bytes of data for 2 beams, 3 ranges and 1 bytes a number");
    message = smallImage();
    message.beam_directions.pop_back();
    EXPECT_EQ(findDiagnostic(message), "sonar image: 1 directions for 2 beams");
    message = smallImage();
    message.image.dtype = 7;
    EXPECT_EQ(findDiagnostic(message),
              "sonar image: dtype 7 is not read, only uint8, uint16, uint32, float32, float64");
    message = smallImage();
    message.ranges[1] = 1;
    EXPECT_EQ(findDiagnostic(message),
              "sonar image: range 1 is 1.000000 m; the ranges must be the centres of equal bins from 0 on");
    message = smallImage();
    message.ping_info.sound_speed = 0;
    EXPECT_EQ(findDiagnostic(message), "sonar image: a speed of sound of 0.000000 m/s");
}

TEST(PingsTest, RefusesCountsWhoseProductOverflows) {
    ProjectedSonarImage message = smallImage();
    message.image.beam_count = 0xffffffff;
    EXPECT_EQ(findDiagnostic(message), "sonar image: 2 directions for 4294967295 beams");
}

}  // namespace
}  // namespace insonify::ros
