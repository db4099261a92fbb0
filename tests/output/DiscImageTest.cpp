#include <gtest/gtest.h>

#include "components/output/pictures/FanImage.hpp"
#include "tests/output/Pixels.hpp"

namespace insonify::output {
namespace {

/** A disc in gray on a fixed scale, to which a head adds one beam after the other. */
struct DiscImageTest : ::testing::Test {
    DiscImageTest() : disc_(test::grayPicture(600)) {}
    static types::Sonar beamAt(double bearing_deg, float value, uint32_t bins = 100) {
        types::Sonar ping = test::emptyPing(3, 1, bins);
        ping.bearings[0] = types::Angle::fromDeg(bearing_deg);
        ping.bins.assign(bins, value);
        return ping;
    }
    void paint(double bearing_deg, float value, uint32_t bins = 100) {
        types::Image picture;
        disc_.paint(beamAt(bearing_deg, value, bins), picture);
        picture_ = test::toPixels(picture);
    }
    /** Returns whether an echo shows at 42 m, away from rings. */
    bool lit(double bearing_deg) const {
        const cv::Point2d at = disc_.layout().pixel(42, types::radians(bearing_deg));
        return picture_.at<cv::Vec3b>(cvRound(at.y), cvRound(at.x))[1] > 150;
    }

    DiscImage disc_;
    cv::Mat picture_;
};

TEST_F(DiscImageTest, APingFillsOnlyTheSectorOfItsBeamWidth) {
    paint(93, 1);
    paint(-170, 0);  // moves the line of the head away
    EXPECT_TRUE(lit(92.2) && lit(93) && lit(93.8));
    EXPECT_FALSE(lit(90.8) || lit(95.2) || lit(-93) || lit(3));
}

TEST_F(DiscImageTest, PortIsLeftAndAsternIsDown) {
    paint(93, 1);
    const cv::Point2d port = disc_.layout().pixel(42, types::radians(93)),
                      astern = disc_.layout().pixel(42, types::radians(179));
    EXPECT_LT(port.x, 150);
    EXPECT_GT(astern.y, 450);
}

TEST_F(DiscImageTest, KeepsOldSectorsUntilTheHeadReturns) {
    paint(47, 1);
    for (double bearing = 57; bearing < 400; bearing += 10) {
        paint(bearing, 0);
        EXPECT_TRUE(lit(47)) << bearing;
    }
    paint(47, 0);
    paint(-170, 0);
    EXPECT_FALSE(lit(47));
}

TEST_F(DiscImageTest, ASectorAsternWrapsAround) {
    paint(179.5, 1);
    paint(0, 0);
    EXPECT_TRUE(lit(178.6) && lit(-179.5));
    EXPECT_FALSE(lit(177) || lit(-178));
}

TEST_F(DiscImageTest, KeepsPingsWithoutAPicture) {
    disc_.skip(beamAt(33, 1));
    paint(-170, 0);
    EXPECT_TRUE(lit(33));
}

TEST_F(DiscImageTest, AnotherNumberOfBinsStartsAnEmptyDisc) {
    paint(33, 1);
    paint(-170, 0, 200);
    EXPECT_FALSE(lit(33));
}

}  // namespace
}  // namespace insonify::output
