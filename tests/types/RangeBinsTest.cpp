#include <gtest/gtest.h>

#include <random>

#include "types/samples/SonarScan.hpp"
#include "types/samples/SonarTruth.hpp"

namespace insonify::types {
namespace {

constexpr double of_float = std::numeric_limits<float>::epsilon();

/** Returns the speed of sound that a sample of Rock's layout contains. */
template <class T>
float describedSpeed(const T& sample) {
    float speed = 0;
    const auto visit = [&](const Field& field, const auto& value) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, float>)
            if (std::string(field.name) == "speed_of_sound") speed = value;
    };
    T::describe(sample, visit);
    return speed;
}

TEST(RangeBinsTest, AnyWidthIsExactInMemoryAndForReadersOfRocksFields) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> exponent(-4, 1), speed(1000, 2000);
    for (int i = 0; i < 10'000; ++i) {
        const double width = std::pow(10, exponent(random)), c = speed(random);  // 0.07 us to 10 ms
        Sonar ping;
        ping.setBins(width, c);
        EXPECT_NEAR(ping.binWidth(), width, 1e-6 * width);
        EXPECT_DOUBLE_EQ(ping.binStart(4000), 4000 * ping.binWidth());
        EXPECT_EQ(ping.speed_of_sound, static_cast<float>(c));
        EXPECT_NEAR(ping.binSeconds() * static_cast<double>(ping.speed_of_sound), ping.binWidth(), 1e-15 * width);
        EXPECT_GE(ping.bin_duration.microseconds, 1);
        const double rocks = ping.bin_duration.seconds() * static_cast<double>(describedSpeed(ping));
        EXPECT_NEAR(rocks, ping.binWidth(), of_float * width) << width << " m at " << c << " m/s";
        SonarTruth truth;
        truth.copyGrid(ping);
        EXPECT_TRUE(truth.sameBins(ping));
        EXPECT_EQ(describedSpeed(truth), describedSpeed(ping));
    }
}

TEST(RangeBinsTest, WholeMicrosecondsKeepRocksFields) {
    for (int64_t us = 1; us < 20'000; us = us * 3 + 1) {
        Sonar ping;
        ping.setBins(static_cast<double>(us) * 1e-6 * 1500, 1500);
        EXPECT_EQ(ping.bin_duration.microseconds, us);
        EXPECT_EQ(ping.bin_width, 0);
        EXPECT_EQ(describedSpeed(ping), 1500);
    }
}

TEST(RangeBinsTest, TheWidthIsRestoredOnlyToItsOwnBins) {
    Sonar ping;
    ping.bin_duration = {3};
    ping.speed_of_sound = static_cast<float>(0.005 / 3e-6);
    Sonar other = ping;
    ping.restore(0.005, 1500);
    EXPECT_EQ(ping.binWidth(), 0.005);
    EXPECT_EQ(ping.speed_of_sound, 1500);
    other.restore(0.00501, 1500);
    EXPECT_EQ(other.bin_width, 0);
    EXPECT_EQ(other.speed_of_sound, static_cast<float>(0.005 / 3e-6));
    Sonar copy;
    copy.copyHeader(ping);
    EXPECT_TRUE(copy.sameBins(ping));
    ping.bin_width = 0.006;
    EXPECT_FALSE(copy.sameBins(ping)) << "of the same rounded duration and speed";
}

TEST(RangeBinsTest, BeamsAndScansOfRockKeepTheirInterval) {
    SonarBeam beam;
    beam.sampling_interval = 2 * 0.0025 / 1490;  // two-way: bins of 1.68 us
    beam.speed_of_sound = 1490;
    beam.beam = {1, 2, 3};
    EXPECT_NEAR(toSonar(beam).binStart(4000), 10, 1e-6);
    SonarScan scan;
    scan.sampling_interval = beam.sampling_interval;
    scan.speed_of_sound = 1490;
    scan.number_of_beams = scan.number_of_bins = 1;
    scan.start_bearing = scan.angular_resolution = Angle::fromDeg(1);
    scan.data = {1};
    EXPECT_NEAR(toSonar(scan).binStart(4000), 10, 1e-6);
    scan.sampling_interval = beam.sampling_interval = 0;
    EXPECT_THROW(toSonar(scan), std::logic_error);
    EXPECT_THROW(toSonar(beam), std::logic_error);
}

}  // namespace
}  // namespace insonify::types
