#include <gmock/gmock.h>

#include <cmath>

#include "components/viewer/Messages.hpp"
#include "tests/support/Fans.hpp"

namespace insonify::viewer {
namespace {

ros::Image makePicture(const types::Sonar& ping) {
    ros::SonarOptions options;
    options.reference_db = 0;
    ros::Image message;
    FanPicture().draw(ping, options, message);
    return message;
}

TEST(FanPictureTest, ARandomFanIsDrawnLikeTheBeamsInAscendingOrder) {
    for (const test::RandomFan& fan : test::randomFans(2, 40))
        EXPECT_EQ(makePicture(fan.ping).data, makePicture(fan.ascending).data) << fan.name;
}

TEST(FanPictureTest, AFanAcrossTheSeamIsBehindTheSonarAndGapsAreEmpty) {
    types::Sonar ping = test::makePing(5, 40);
    const double bearings_deg[] = {-155, 160, 165, 170, -160};  // a gap from 172.5 to -162.5 degrees
    for (size_t beam = 0; beam < 5; ++beam) ping.bearings[beam] = types::Angle::fromDeg(bearings_deg[beam]);
    ping.beam_width = types::Angle::fromDeg(5);
    const ros::Image picture = makePicture(ping);
    // The sonar is at the middle of the upper edge, the range is the height.
    const double port = std::sin(types::radians(22.5)), starboard = std::sin(types::radians(27.5));
    const double middle = picture.width * port / (port + starboard);
    size_t lit = 0;
    for (uint32_t row = 0; row < picture.height; ++row)
        for (uint32_t column = 0; column < picture.width; ++column) {
            const double bearing = std::atan2(middle - column - 0.5, -(row + 0.5));
            const double distance = std::hypot(middle - column - 0.5, row + 0.5);
            const double apart = types::degrees(test::nearestBeam(ping, bearing));
            const bool shown = picture.data[size_t{row} * picture.width + column] > 0;
            ASSERT_FALSE(shown && apart > 2.6 + 60 / distance) << column << " " << row;
            ASSERT_TRUE(shown || apart > 2.4 - 60 / distance || distance > picture.height - 2) << column << " " << row;
            lit += shown;
        }
    EXPECT_GT(lit, picture.data.size() / 4);
}

TEST(FanPictureTest, APingWithoutKnownBearingsIsAnEmptyPicture) {
    types::Sonar ping = test::makePing(3, 40);
    ping.bearings.assign(3, types::Angle{});
    EXPECT_THAT(makePicture(ping).data, testing::Each(0));
}

}  // namespace
}  // namespace insonify::viewer
