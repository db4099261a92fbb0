#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "components/output/pictures/FanImage.hpp"
#include "components/output/pictures/Overlay.hpp"
#include "tests/output/Pixels.hpp"

namespace insonify::output {
namespace {

using test::centreOfDifference;
using test::emptyPing;
using test::toPixels;
using test::withEcho;

cv::Mat paint(FanImage& fan, const types::Sonar& ping) {
    types::Image picture;
    fan.paint(ping, picture);
    return toPixels(picture);
}

/** Returns the place of one bin's echo: the difference from a ping without it. */
cv::Point2d getPlace(FanImage& fan, const types::Sonar& empty, uint32_t beam, uint32_t bin) {
    return centreOfDifference(paint(fan, empty), paint(fan, withEcho(empty, beam, bin)));
}

double levelAt(const cv::Mat& picture, cv::Point2d at) {
    return picture.at<cv::Vec3b>(cvRound(at.y), cvRound(at.x))[1];
}

TEST(FanImageTest, AheadIsUpAndPortIsLeft) {
    FanImage fan(test::grayPicture(800));
    const types::Sonar empty = emptyPing(120, 121);
    const cv::Point2d ahead = getPlace(fan, empty, 60, 80), port = getPlace(fan, empty, 110, 80);
    const cv::Point2d starboard = getPlace(fan, empty, 10, 80);
    EXPECT_NEAR(ahead.x, 399.5, 1);
    EXPECT_LT(port.x, 200);
    EXPECT_GT(starboard.x, 600);
    EXPECT_LT(ahead.y, port.y);
    EXPECT_NEAR(port.y, starboard.y, 1);
}

TEST(FanImageTest, ShowsAnEchoAtItsBearingAndRange) {
    FanImage fan(test::grayPicture(800));
    const types::Sonar empty = emptyPing(130, 128);
    paint(fan, empty);
    const cv::Point2d origin = fan.layout().origin();
    for (uint32_t beam = 0; beam < 128; beam += 9)
        for (const uint32_t bin : {30u, 60u, 95u}) {
            const double bearing = empty.bearings[beam].rad, share = (bin + 0.5) / 100;
            const cv::Point2d expected(origin.x - fan.layout().radius() * share * std::sin(bearing),
                                       origin.y - fan.layout().radius() * share * std::cos(bearing));
            const cv::Point2d place = getPlace(fan, empty, beam, bin);
            EXPECT_LT(cv::norm(place - expected), 2.5) << beam << " " << bin;  // a bin is 3.8 pixels long
        }
}

TEST(FanImageTest, LabelsOverEchoesAreOnADarkPlate) {
    for (const auto& [half, darkest] : {std::pair(M_PI, 50), {M_PI / 3, 200}}) {  // a fan has its labels at its side
        const Overlay overlay = fanOverlay(FanLayout(600, -half, half, 50), {-1000, -1000}, {});
        cv::Mat picture(overlay.size(), CV_8UC3, cv::Scalar(200, 200, 200));
        overlay.blend(picture);
        double least = 0;
        cv::minMaxLoc(picture.reshape(1), &least);
        EXPECT_EQ(least, darkest) << half;
    }
}

TEST(FanImageTest, DrawsRingsAtRoundRanges) {
    FanImage fan(test::grayPicture(800));
    const cv::Mat picture = paint(fan, emptyPing(120, 60, 1000));
    const double range = fan.layout().range();
    const double between_spokes = types::radians(15.5);
    for (const double ring : {10.0, 20.0, 30.0, 40.0}) {
        EXPECT_GT(levelAt(picture, fan.layout().pixel(ring, between_spokes)), 30) << ring;
        EXPECT_EQ(levelAt(picture, fan.layout().pixel(ring + 0.02 * range, between_spokes)), 0) << ring;
        EXPECT_EQ(levelAt(picture, fan.layout().pixel(ring - 0.02 * range, between_spokes)), 0) << ring;
    }
}

TEST(FanImageTest, TheLevelOfAnEchoIsItsDecibelsWithinTheDynamicRange) {
    FanImage fan(test::grayPicture(800));
    types::Sonar ping = emptyPing(120, 60);
    paint(fan, ping);
    const cv::Point2d place = fan.layout().pixel(33.3, types::radians(13));
    for (const auto& [value, level] : {std::pair(1.0, 255), {0.01, 128}, {1e-4, 0}, {1e-9, 0}, {100.0, 255}}) {
        ping.bins.assign(ping.bins.size(), static_cast<float>(value));
        EXPECT_NEAR(levelAt(paint(fan, ping), place), level, 1) << value;
    }
}

TEST(FanImageTest, KeepsTablesUntilTheShapeChanges) {
    FanImage fan(test::grayPicture(800));
    types::Sonar ping = emptyPing(120, 60);
    for (int i = 0; i < 3; ++i) paint(fan, withEcho(ping, 3, static_cast<uint32_t>(i)));
    EXPECT_EQ(fan.tablesBuilt(), 1);
    ping.bearings[0].rad -= 0.01;
    paint(fan, ping);
    EXPECT_EQ(fan.tablesBuilt(), 2);
    ping.speed_of_sound = 1400;
    paint(fan, ping);
    EXPECT_EQ(fan.tablesBuilt(), 3);
}

TEST(FanImageTest, ShowsUnevenBearingsInAnyOrderAtTheirPlace) {
    FanImage fan(test::grayPicture(800));
    types::Sonar ping = emptyPing(100, 5);
    const double bearings[] = {40, -45, 5, std::numeric_limits<double>::quiet_NaN(), -10};
    for (size_t beam = 0; beam < 5; ++beam) ping.bearings[beam].rad = types::radians(bearings[beam]);
    ping.beam_width = types::Angle::fromDeg(4);
    paint(fan, ping);
    for (const uint32_t beam : {0u, 1u, 2u, 4u}) {
        const cv::Mat picture = paint(fan, withEcho(ping, beam, 80));
        // Half a degree aside, away from spokes.
        EXPECT_GT(levelAt(picture, fan.layout().pixel(40.25, types::radians(bearings[beam] + 0.7))), 200) << beam;
    }
    EXPECT_NEAR(types::degrees(fan.layout().left()), 42, 1e-9);
    EXPECT_NEAR(types::degrees(fan.layout().right()), -47, 1e-9);
}

TEST(FanImageTest, PaintsBackgroundOutsideTheFan) {
    FanImage fan(test::grayPicture(800));
    types::Sonar ping = emptyPing(120, 60);
    ping.bins.assign(ping.bins.size(), 1);
    const cv::Mat picture = paint(fan, ping);
    const cv::Vec3b ground(26, 19, 14);
    EXPECT_EQ(picture.at<cv::Vec3b>(picture.rows - 4, 4), ground);
    EXPECT_EQ(picture.at<cv::Vec3b>(picture.rows - 4, picture.cols - 4), ground);
}

TEST(FanImageTest, AFullCircleHasNoSeamAstern) {
    FanImage fan(test::grayPicture(800));
    types::Sonar ping = emptyPing(360, 90);
    ping.bins.assign(ping.bins.size(), 1);
    const cv::Mat picture = paint(fan, ping);
    const cv::Point2d origin = fan.layout().origin();
    for (int offset = -20; offset <= 20; ++offset)
        EXPECT_GE(levelAt(picture, {origin.x + offset, origin.y + 200}), 200) << offset;
}

TEST(FanImageTest, ATitleDescribesThePicture) {
    FanImage fan(test::grayPicture(800));
    types::Image picture;
    fan.paint(emptyPing(120, 60), picture);
    EXPECT_EQ(picture.time, types::Time::fromSeconds(1));
    EXPECT_EQ(picture.size.width, 800);
    EXPECT_EQ(picture.frame_mode, types::ImageMode::Bgr);
    EXPECT_EQ(picture.frame_status, types::ImageStatus::Valid);
    EXPECT_EQ(picture.row_size, 2400u);
    EXPECT_EQ(picture.image.size(), size_t{2400} * picture.size.height);
}

TEST(FanImageTest, SizesAreEvenForVideoCodecs) {
    DisplayConfig config = test::grayPicture(800);
    config.width = 801;
    for (const double field_of_view : {1.0, 20.0, 130.0, 270.0, 360.0}) {
        FanImage fan(config);
        const cv::Mat picture = paint(fan, emptyPing(field_of_view, 10));
        EXPECT_EQ(picture.cols, 802);
        EXPECT_EQ(picture.rows % 2, 0) << field_of_view;
    }
}

TEST(FanImageTest, DrawsUnusualPings) {
    types::Sonar one = emptyPing(1, 1, 1), unknown = emptyPing(90, 3), nothing;
    unknown.bins.assign(unknown.bins.size(), std::numeric_limits<float>::quiet_NaN());
    types::Sonar infinite = withEcho(emptyPing(90, 3), 1, 1, std::numeric_limits<float>::infinity());
    types::Sonar no_bearings = emptyPing(90, 3);
    no_bearings.bearings.clear();
    for (const types::Sonar& ping : {one, unknown, nothing, infinite, no_bearings}) {
        FanImage fan({});
        EXPECT_EQ(paint(fan, ping).cols, 1024);
    }
}

}  // namespace
}  // namespace insonify::output
