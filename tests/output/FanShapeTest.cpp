#include <gtest/gtest.h>

#include <numbers>

#include "components/output/FanShape.hpp"
#include "tests/output/Pixels.hpp"

namespace insonify::output {
namespace {

TEST(FanShapeTest, BeamsAreOrderedFromStarboardToPortAndUnknownOnesLeftOut) {
    types::Sonar ping = test::emptyPing(90, 3);
    ping.bearings = {types::Angle{0.5}, types::Angle{}, types::Angle{-0.5}};
    const FanShape shape = FanShape::of(ping);
    EXPECT_EQ(shape.beams, (std::vector<uint32_t>{2, 0}));
    EXPECT_EQ(shape.bearings, (std::vector<double>{-0.5, 0.5}));
}

TEST(FanShapeTest, EdgesLieHalfABeamBeyondTheOutermostCentres) {
    types::Sonar ping = test::emptyPing(120, 60);
    EXPECT_NEAR(FanShape::of(ping).left, types::radians(60), 1e-12);
    ping.beam_width = types::Angle{};
    EXPECT_NEAR(FanShape::of(ping).right, -types::radians(60), 1e-12);
    EXPECT_TRUE(FanShape::of(test::emptyPing(360, 10)).fullCircle());
    EXPECT_FALSE(FanShape::of(test::emptyPing(350, 10)).fullCircle());
}

TEST(FanShapeTest, ABearingBetweenTwoCentresIsAFractionOfABeam) {
    FanShape shape;
    shape.bearings = {-0.4, 0.0, 0.1};
    EXPECT_DOUBLE_EQ(shape.beamAt(-0.1), 0.75);
    EXPECT_DOUBLE_EQ(shape.beamAt(0.05), 1.5);
    EXPECT_DOUBLE_EQ(shape.beamAt(-1), 0);
    EXPECT_DOUBLE_EQ(shape.beamAt(1), 2);
}

TEST(FanLayoutTest, TheWholeFanLiesInThePicture) {
    for (const double half : {0.005, 0.2, 1.0, 1.5, 2.0, 3.0, std::numbers::pi}) {
        const FanLayout layout(600, -half, half, 50);
        for (int step = -10; step <= 10; ++step) {
            const cv::Point2d at = layout.pixel(50, half * step / 10);
            EXPECT_TRUE(at.x >= 0 && at.x < layout.size().width) << half;
            EXPECT_TRUE(at.y >= FanLayout::title_height && at.y < layout.size().height) << half;
        }
        EXPECT_LT(layout.origin().y, layout.size().height) << half;
    }
}

}  // namespace
}  // namespace insonify::output
