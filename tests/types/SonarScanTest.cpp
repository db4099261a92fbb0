#include <gmock/gmock.h>

#include "types/samples/SonarScan.hpp"

namespace insonify::types {
namespace {

SonarScan makeScan(std::vector<uint8_t> data, uint16_t beams, uint16_t bins) {
    SonarScan scan;
    scan.time = {5};
    scan.data = std::move(data);
    scan.number_of_beams = beams;
    scan.number_of_bins = bins;
    scan.start_bearing = Angle::fromDeg(30);
    scan.angular_resolution = Angle::fromDeg(30);
    scan.sampling_interval = 2e-3;
    scan.speed_of_sound = 1500;
    return scan;
}

TEST(SonarScanTest, BearingsOfAScanDecreaseFromPortToStarboard) {
    const Sonar ping = toSonar(makeScan({0, 51, 255}, 3, 1));
    std::vector<double> degrees;
    for (const Angle& bearing : ping.bearings) degrees.push_back(bearing.deg());
    EXPECT_THAT(degrees, testing::ElementsAre(testing::DoubleNear(30, 1e-12), testing::DoubleNear(0, 1e-12),
                                              testing::DoubleNear(-30, 1e-12)));
    EXPECT_THAT(ping.bins, testing::ElementsAre(0, 0.2f, 1));
    EXPECT_EQ(ping.bin_duration, Time{1000}) << "half of the way there and back";
    EXPECT_NO_THROW(ping.validate());
}

TEST(SonarScanTest, EitherMemoryLayoutGivesTheSamePing) {
    SonarScan columns = makeScan({0, 255, 51, 0, 0, 51}, 2, 3);
    SonarScan rows = makeScan({0, 51, 0, 255, 0, 51}, 2, 3);
    rows.memory_layout_column = false;
    EXPECT_EQ(toSonar(columns).bins, toSonar(rows).bins);
    EXPECT_THAT(toSonar(rows).bins, testing::ElementsAre(0, 0.2f, 0, 1, 0, 0.2f));
}

TEST(SonarScanTest, ABeamThatIsNotSetIsUnknown) {
    SonarScan scan = makeScan({255, 255}, 2, 1);
    scan.time_beams = {{4}, {}};
    const Sonar ping = toSonar(scan);
    EXPECT_THAT(ping.bins, testing::ElementsAre(1, testing::IsNan()));
    EXPECT_EQ(ping.beamStart(0), Time{4});
}

TEST(SonarScanTest, RejectsInvalidScans) {
    SonarScan scan = makeScan({1, 2, 3}, 2, 2);
    EXPECT_THROW(toSonar(scan), std::logic_error);
    scan = makeScan({1, 2}, 2, 1);
    scan.polar_coordinates = false;
    EXPECT_THROW(toSonar(scan), std::logic_error);
    scan = makeScan({1, 2}, 2, 1);
    scan.sampling_interval = -1;
    EXPECT_THROW(toSonar(scan), std::logic_error);
}

TEST(SonarScanTest, ABeamIsAPingOfOneBeam) {
    SonarBeam beam;
    beam.bearing = Angle::fromDeg(-90);
    beam.sampling_interval = 200e-6;
    beam.speed_of_sound = 1480;
    beam.beam = {255, 0};
    const Sonar ping = toSonar(beam);
    EXPECT_THAT(ping.bins, testing::ElementsAre(1, 0));
    EXPECT_DOUBLE_EQ(ping.bearings.at(0).deg(), -90);
    EXPECT_NEAR(ping.binStart(1), 0.148, 1e-6);
    EXPECT_NO_THROW(ping.validate());
    EXPECT_THROW(toSonar(SonarBeam{}), std::logic_error) << "no interval";
}

}  // namespace
}  // namespace insonify::types
