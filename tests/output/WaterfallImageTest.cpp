#include <gtest/gtest.h>

#include "components/output/pictures/WaterfallImage.hpp"
#include "tests/output/Pixels.hpp"

namespace insonify::output {
namespace {

using test::levelAt;

TEST(WaterfallImageTest, TheNewestPingIsOnTopAndRangeGrowsToTheRight) {
    WaterfallImage waterfall(test::grayPicture(600));
    types::Image picture;
    waterfall.paint(test::withEcho(test::emptyPing(3, 1), 0, 25), picture);
    waterfall.paint(test::withEcho(test::emptyPing(3, 1), 0, 75), picture);
    const cv::Rect water = waterfall.water();
    const int near_x = water.x + cvRound(0.255 * water.width), far_x = water.x + cvRound(0.755 * water.width);
    EXPECT_GT(levelAt(picture, {far_x, water.y}), 240);
    EXPECT_EQ(levelAt(picture, {near_x, water.y}), 0);
    EXPECT_GT(levelAt(picture, {near_x, water.y + 1}), 240);
}

TEST(WaterfallImageTest, ARowIsTheMeanOverTheBeams) {
    WaterfallImage waterfall(test::grayPicture(600));
    types::Sonar ping = test::emptyPing(90, 10);
    for (uint32_t bin = 0; bin < 100; ++bin) ping.bins[bin] = 0.1f;  // 0.01 over ten beams: 20 dB of 40
    types::Image picture;
    waterfall.paint(ping, picture);
    EXPECT_NEAR(levelAt(picture, waterfall.water().tl() + cv::Point(200, 0)), 128, 1);
}

TEST(WaterfallImageTest, OldPingsLeaveAtTheBottom) {
    WaterfallImage waterfall(test::grayPicture(600));
    types::Sonar bright = test::emptyPing(3, 1);
    bright.bins.assign(bright.bins.size(), 1);
    waterfall.skip(bright);
    types::Image picture;
    const cv::Point bottom = waterfall.water().tl() + cv::Point(200, WaterfallImage::history - 1);
    for (int i = 0; i < WaterfallImage::history - 2; ++i) waterfall.skip(test::emptyPing(3, 1));
    waterfall.paint(test::emptyPing(3, 1), picture);
    EXPECT_EQ(levelAt(picture, bottom), 255);
    waterfall.paint(test::emptyPing(3, 1), picture);
    EXPECT_EQ(levelAt(picture, bottom), 0);
}

TEST(WaterfallImageTest, DrawsAPingWithoutBeams) {
    WaterfallImage waterfall(test::grayPicture(600));
    types::Image picture;
    waterfall.paint(types::Sonar{}, picture);
    EXPECT_EQ(picture.size.width, 600);
}

}  // namespace
}  // namespace insonify::output
