#include <gtest/gtest.h>

#include <numbers>

#include "components/output/pictures/FanShape.hpp"
#include "tests/output/Pixels.hpp"

namespace insonify::output {
namespace {

TEST(FanLayoutTest, TheWholeFanIsInThePicture) {
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

TEST(FanLayoutTest, AFanAcrossTheSeamIsBehindTheSonarInThePicture) {
    const FanLayout layout(600, types::radians(150), types::radians(210), 50);
    for (const double bearing : {150, 180, 210}) {
        const cv::Point2d at = layout.pixel(50, types::radians(bearing));
        EXPECT_GT(at.y, layout.origin().y) << bearing;
        EXPECT_LT(at.y, layout.size().height) << bearing;
    }
}

}  // namespace
}  // namespace insonify::output
