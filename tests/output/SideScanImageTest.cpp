#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "components/output/tasks/SideScanImageTask.hpp"
#include "tests/output/Pixels.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::output {
namespace {

using test::levelAt;

/** Returns a line of 50 m with single echoes to starboard and to port, in bins of half a metre. */
types::Sonar lineWith(uint32_t starboard, uint32_t port) {
    types::Sonar ping = test::withEcho(test::withEcho(test::emptyPing(3, 2), 0, starboard), 1, port);
    ping.bearings = {types::Angle::fromDeg(-90), types::Angle::fromDeg(90)};
    return ping;
}

/** Returns the pixel of a range in the newest row; positive to starboard [m]. */
cv::Point at(const SideScanImage& image, double range) {
    const cv::Rect water = image.water();
    return {water.x + static_cast<int>(std::floor(water.width * (0.5 + range / 100))), water.y};
}

TEST(SideScanImageTest, PortIsLeftAndStarboardIsRightOfTheMiddle) {
    SideScanImage image(test::grayPicture<SideScanPictureConfig>(600));
    types::Image picture;
    const types::Sonar ping = lineWith(20, 60);
    const double bin = ping.binStart(1);
    image.paint(ping, picture);
    EXPECT_GT(levelAt(picture, at(image, 20.5 * bin)), 200);
    EXPECT_GT(levelAt(picture, at(image, -60.5 * bin)), 200);
    EXPECT_EQ(levelAt(picture, at(image, -20.5 * bin)), 0);
    EXPECT_EQ(levelAt(picture, at(image, 60.5 * bin)), 0);
}

TEST(SideScanImageTest, RowsAlongTheGroundHaveNoWaterColumn) {
    auto config = test::grayPicture<SideScanPictureConfig>(600);
    config.ground_range.emplace();
    config.ground_range->altitude = 15;
    SideScanImage image(config);
    types::Image picture;
    const types::Sonar ping = lineWith(40, 80);
    const double bin = ping.binStart(1);
    image.paint(ping, picture);
    EXPECT_GT(levelAt(picture, at(image, std::sqrt(std::pow(40.5 * bin, 2) - 225))), 200);
    EXPECT_GT(levelAt(picture, at(image, -std::sqrt(std::pow(80.5 * bin, 2) - 225))), 200);
    EXPECT_EQ(levelAt(picture, at(image, 40.5 * bin)), 0) << "its slant range";
}

TEST(SideScanImageTest, TheHeightIsMeasuredOrThatOfTheFirstReturn) {
    auto config = test::grayPicture<SideScanPictureConfig>(600);
    config.ground_range.emplace();
    SideScanImage image(config);
    types::Image picture;
    types::Sonar ping = test::withEcho(lineWith(40, 60), 1, 24);  // the first return of both sides: the bottom
    ping = test::withEcho(ping, 1, 10, 1e-3f);                    // weaker than the threshold
    const double bin = ping.binStart(1), height = 24.5 * bin;
    image.paint(ping, picture);
    EXPECT_GT(levelAt(picture, at(image, std::sqrt(std::pow(40.5 * bin, 2) - height * height))), 200);
    image.setAltitude(10);
    image.paint(ping, picture);
    EXPECT_GT(levelAt(picture, at(image, std::sqrt(std::pow(40.5 * bin, 2) - 100))), 200);
}

TEST(SideScanImageTest, EachPingUsesThePortsAltitudeAtItsTime) {
    SideScanImageTask task("side_scan");
    auto config = test::grayPicture<SideScanPictureConfig>(600);
    config.ground_range.emplace();
    task.config.set(config);
    test::Writer<types::SonarPtr> pings;
    test::Writer<types::Range> altitudes;
    test::Reader<types::ImagePtr> pictures;
    pings.port.connectTo(task.ping, framework::ConnPolicy::buffer(8));
    altitudes.port.connectTo(task.altitude, framework::ConnPolicy::buffer(8));
    task.image.connectTo(pictures.port, framework::ConnPolicy::buffer(8));
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    const auto altitudeAt = [](int second) { return 4.0 + 3 * second; };
    for (int second = 1; second <= 4; ++second) {
        types::Range measured;
        measured.time = types::Time::fromSeconds(second);
        measured.range = altitudeAt(second);
        altitudes.port.write(measured);
    }
    const SideScanImage layout(config);
    for (const double time : {0.5, 1.0, 2.9, 3.0, 7.0}) {  // the first is before any altitude
        types::Sonar ping = lineWith(40, 60);
        ping.time = types::Time::fromSeconds(time);
        pings.port.write(test::shared(ping));
        task.update();
        types::ImagePtr picture;
        ASSERT_TRUE(pictures.port.readNew(picture));
        const double altitude = altitudeAt(std::clamp(static_cast<int>(time), 1, 4));
        EXPECT_GT(levelAt(*picture, at(layout, std::sqrt(std::pow(40.5 * ping.binStart(1), 2) - altitude * altitude))),
                  200)
            << time;
    }
}

TEST(SideScanImageTest, APingWithoutASideLeavesItBlank) {
    SideScanImage image(test::grayPicture<SideScanPictureConfig>(600));
    types::Image picture;
    types::Sonar ping = lineWith(20, 20);
    ping.bearings[1] = {-0.5};
    image.paint(ping, picture);
    EXPECT_EQ(levelAt(picture, at(image, -20.5 * ping.binStart(1))), 0);
    EXPECT_GT(levelAt(picture, at(image, 20.5 * ping.binStart(1))), 200);
}

}  // namespace
}  // namespace insonify::output
