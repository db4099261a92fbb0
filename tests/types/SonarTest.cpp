#include <gmock/gmock.h>

#include <numbers>

#include "tests/support/Refused.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::types {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/** Returns beams with bins of 1, 2, 3... */
Sonar ping(uint32_t bins, uint32_t beams) {
    Sonar sample;
    sample.resize(bins, beams);
    sample.bin_duration = {10};
    for (size_t i = 0; i < sample.bins.size(); ++i) sample.bins[i] = static_cast<float>(i + 1);
    return sample;
}

std::string findDiagnostic(const Sonar& sample) {
    return test::computeError<std::logic_error>([&] { sample.validate(); });
}

TEST(SonarTest, BinsStartAtOneWayTimeTimesSpeed) {
    Sonar ping;
    ping.bin_duration = {100};
    ping.speed_of_sound = 1500;
    EXPECT_NEAR(ping.binStart(10), 1.5, 1e-9);
}

TEST(SonarTest, AResizedPingKeepsEachValueWithItsBeamAndBin) {
    Sonar sample = ping(2, 2);
    sample.resize(3, 3);
    EXPECT_THAT(sample.bins, testing::ElementsAre(1, 2, testing::IsNan(), 3, 4, testing::IsNan(), testing::IsNan(),
                                                  testing::IsNan(), testing::IsNan()));
    EXPECT_TRUE(sample.bearings.at(2).isUnknown());
    EXPECT_TRUE(sample.timestamps.empty());
    sample.resize(1, 2, true);
    EXPECT_THAT(sample.bins, testing::ElementsAre(1, 3));
    EXPECT_THAT(sample.timestamps, testing::ElementsAre(Time{}, Time{}));
    EXPECT_EQ(findDiagnostic(sample), "");
}

TEST(SonarTest, RegularBearingsAreExactAndNormalised) {
    Sonar sample = ping(1, 512);
    const double step = 2 * std::numbers::pi / 512;
    sample.setRegularBearings(Angle::fromRad(0), {step});
    EXPECT_EQ(sample.bearings.at(100).rad, 100 * step);
    EXPECT_NEAR(sample.bearings.at(511).rad, -step, 1e-15);
    EXPECT_EQ(findDiagnostic(sample), "");
}

TEST(SonarTest, ABeamStartsAtItsOwnTimeOrAtThatOfThePing) {
    Sonar sample = ping(1, 2);
    sample.time = {7};
    EXPECT_EQ(sample.beamStart(1), Time{7});
    sample.timestamps = {{8}, {9}};
    EXPECT_EQ(sample.beamStart(1), Time{9});
    EXPECT_THROW(sample.beamStart(2), std::out_of_range);
}

TEST(SonarTest, ValidationReportsEveryError) {
    EXPECT_EQ(findDiagnostic(Sonar{}), "") << "empty, as in Rock";
    EXPECT_EQ(findDiagnostic(ping(4, 3)), "") << "unknown bearings";
    Sonar sample = ping(4, 3);
    sample.bins.pop_back();
    sample.bearings[0] = {4};
    sample.timestamps.resize(1);
    sample.bin_duration = {};
    sample.speed_of_sound = nan;
    EXPECT_FALSE(sample.wellShaped());
    EXPECT_EQ(
        findDiagnostic(sample),
        "a ping has 11 bins, must have 12; has 1 timestamps, must have 3 or none; has a bearing outside (-pi, pi]; "
        "has bins without a duration; has bins without a speed of sound");
}

TEST(SonarTest, RejectsCountsWhoseProductOverflows) {
    Sonar sample;
    sample.bin_count = 1u << 16;
    sample.beam_count = 1u << 16;  // 2^32 bins: 0 in 32 bits
    sample.bearings.resize(sample.beam_count);
    EXPECT_FALSE(sample.wellShaped());
    EXPECT_EQ(findDiagnostic(sample), "a ping has 0 bins, must have 4294967296");
}

}  // namespace
}  // namespace insonify::types
