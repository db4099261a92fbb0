// Pictures of fans whose beams have random bearings, in any order.
#include <gmock/gmock.h>

#include "components/output/maps/ScanMosaic.hpp"
#include "components/output/pictures/FanImage.hpp"
#include "components/output/pictures/PlainPicture.hpp"
#include "components/output/pictures/TruthImage.hpp"
#include "tests/output/Pixels.hpp"
#include "tests/support/Fans.hpp"

namespace insonify::output {
namespace {

using test::nearestBeam;
using test::RandomFan;
using test::randomFans;

template <class Picture>
types::Image fanPicture(const types::Sonar& ping) {
    Picture painter(test::grayPicture(400));
    types::Image picture;
    painter.paint(ping, picture);
    return picture;
}

types::Sonar filled(types::Sonar ping, float value) {
    std::ranges::fill(ping.bins, value);
    return ping;
}

void paintInto(FanImage& painter, const types::Sonar& ping, types::Image& picture) { painter.paint(ping, picture); }

/** Paints without the line of the head, which hides echoes. */
void paintInto(DiscImage& painter, types::Sonar ping, types::Image& picture) {
    painter.skip(ping);
    ping.bearings.assign(ping.beam_count, types::Angle{});
    painter.paint(ping, picture);
}

/** Expects that a picture shows echoes at beams and nothing in gaps. */
template <class Picture>
void expectWater(const types::Sonar& ping, const std::string& name, double margin) {
    Picture loud_picture(test::grayPicture(400)), silent_picture(test::grayPicture(400));
    types::Image loud, silent;
    paintInto(loud_picture, filled(ping, 1), loud);
    paintInto(silent_picture, filled(ping, 0), silent);
    const FanLayout& layout = loud_picture.layout();
    const cv::Mat echoes = test::toPixels(loud), nothing = test::toPixels(silent);
    for (int y = FanLayout::title_height; y < echoes.rows; ++y)
        for (int x = 0; x < echoes.cols; ++x) {
            const double ahead = layout.origin().y - y, port = layout.origin().x - x;
            const double apart = nearestBeam(ping, std::atan2(port, ahead)), distance = std::hypot(ahead, port);
            const bool shown = echoes.at<cv::Vec3b>(y, x) != nothing.at<cv::Vec3b>(y, x);
            const bool outside = distance > layout.radius() || apart > ping.beam_width.rad + margin;
            const bool inside = distance < layout.radius() - 1 && apart < ping.beam_width.rad / 2 - margin;
            ASSERT_TRUE(shown ? !outside : !inside) << name << " " << x << " " << y;
        }
}

TEST(FanOrderTest, AFanPictureEqualsThatOfTheBeamsInAscendingOrder) {
    for (const RandomFan& fan : randomFans(3, 40))
        EXPECT_EQ(fanPicture<FanImage>(fan.ping).image, fanPicture<FanImage>(fan.ascending).image) << fan.name;
}

TEST(FanOrderTest, AFanPictureShowsEchoesAtBeamsAndNothingInGaps) {
    for (const RandomFan& fan : randomFans(3, 40)) expectWater<FanImage>(fan.ping, fan.name, 1e-9);
}

TEST(FanOrderTest, ADiscShowsEachDirectionsNearestBeam) {
    const double sector = 2 * std::numbers::pi / DiscImage::sectors;
    for (const RandomFan& fan : randomFans(3, 40)) {
        expectWater<DiscImage>(fan.ping, fan.name, 2 * sector);
        EXPECT_EQ(fanPicture<DiscImage>(fan.ping).image, fanPicture<DiscImage>(fan.ascending).image) << fan.name;
    }
}

TEST(FanOrderTest, EachPixelOfAPlainFanShowsTheNearestBeam) {
    for (const RandomFan& fan : randomFans(3, 40)) {
        PlainConfig config;
        config.height = 150;
        PlainPicture picture(config);
        picture.take(fan.ping);
        size_t pixels = 0;
        for (uint32_t y = 0; y < picture.height(); ++y)
            for (uint32_t x = 0; x < picture.width(); ++x) {
                const double port = picture.width() / 2.0 - 0.5 - x, ahead = 149.5 - y;
                const double bearing = std::atan2(port, ahead), nearest = nearestBeam(fan.ping, bearing);
                const int32_t cell = picture.cells()[size_t{y} * picture.width() + x];
                if (cell < 0) {
                    ASSERT_TRUE(std::hypot(port, ahead) >= 150 || nearest > fan.ping.beam_width.rad / 2 - 1e-9);
                    continue;
                }
                ++pixels;
                const size_t beam = static_cast<uint32_t>(cell) / picture.cellsPerBeam();
                ASSERT_NEAR(test::apart(fan.ping.bearings[beam].rad, bearing), nearest, 1e-9) << fan.name;
                ASSERT_LT(nearest, fan.ping.beam_width.rad + 1e-9) << fan.name;
            }
        EXPECT_GT(pixels, 0u) << fan.name;
        config.shape = PlainShape::Polar;
        PlainPicture polar(config), ascending(config);
        polar.take(fan.ping);
        ascending.take(fan.ascending);
        EXPECT_EQ(polar.image().image, ascending.image().image) << fan.name;
    }
}

TEST(FanOrderTest, ATruthPictureEqualsThatOfTheBeamsInAscendingOrder) {
    const auto paint = [](const types::Sonar& ping) {
        types::SonarTruth truth;
        truth.copyGrid(ping);
        truth.objects = {"one", "two", "three"};
        for (size_t i = 0; i < truth.object.size(); ++i)
            truth.object[i] = static_cast<int32_t>(ping.bins[i] * 1e4f) % 3;
        std::ranges::fill(truth.shadow, uint8_t{0});
        TruthImage painter(test::grayPicture(400));
        painter.setTruth(truth);
        types::Image picture;
        painter.paint(ping, picture);
        return picture.image;
    };
    for (const RandomFan& fan : randomFans(1, 40)) EXPECT_EQ(paint(fan.ping), paint(fan.ascending)) << fan.name;
}

TEST(FanOrderTest, AMapEqualsThatOfTheBeamsInAscendingOrderAndShowsTheNearestBeam) {
    types::Pose pose;
    pose.position = {0, 0, 0};
    for (const RandomFan& fan : randomFans(2, 40)) {
        const double range = fan.ping.binStart(40);
        ScanMap any(80, range), ascending(80, range), beams(80, range);
        any.lay(fan.ping, pose);
        ascending.lay(fan.ascending, pose);
        EXPECT_EQ(cv::norm(any.cells() != ascending.cells(), cv::NORM_L1),
                  cv::norm(any.cells() != any.cells(), cv::NORM_L1))
            << fan.name << ": NaN alone differs from itself";
        types::Sonar numbered = fan.ping;
        for (size_t i = 0; i < numbered.bins.size(); ++i) numbered.bins[i] = static_cast<float>(i / 40);
        beams.lay(numbered, pose);
        for (int row = 0; row <= 160; ++row)
            for (int column = 0; column <= 160; ++column) {
                const float beam = beams.cells().at<float>(row, column);
                const double bearing = std::atan2(80 - column, 80 - row), distance = std::hypot(80 - column, 80 - row);
                if (std::isnan(beam) || distance < 1) continue;
                const double apart = test::apart(fan.ping.bearings[static_cast<size_t>(beam)].rad, bearing);
                ASSERT_LT(apart, nearestBeam(fan.ping, bearing) + 1.5 / distance) << fan.name;
            }
    }
}

TEST(FanOrderTest, TheSimilarityOfPingsDoesNotDependOnTheOrderOfBeams) {
    for (const RandomFan& fan : randomFans(1, 40)) {
        types::Sonar other = fan.ping;
        for (size_t i = 0; i < other.bins.size(); i += 3) other.bins[i] *= 0.3f;
        EXPECT_DOUBLE_EQ(structuralSimilarity(fan.ping, other, test::grayPicture(400)),
                         structuralSimilarity(fan.ascending, test::reordered(other, fan.order), test::grayPicture(400)))
            << fan.name;
    }
}

}  // namespace
}  // namespace insonify::output
