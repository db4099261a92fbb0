// The straightness of the walls, measured in the picture of deploy/tank_mosaic.yml.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "components/output/pictures/FanShape.hpp"
#include "tests/deployer/Command.hpp"
#include "tests/output/Room.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify;
using namespace insonify::deployer;

namespace {

constexpr int half_width = 2 * 420 + 112;  ///< Half the width of the picture [px].

/** The picture of the ping that completes the head's turn: at 20 s, turned about, 1.7 m north and 1.5 m west. */
struct MosaicRunTest : testing::Test {
    static void SetUpTestSuite() {
        const deployer::TestFolder folder;
        const fs::path deployment = fs::path(test::source_dir) / "deploy/tank_mosaic.yml";
        const Outcome outcome =
            callInsonify(folder, {"run", deployment, "--out", "out", "--set", "mosaic.every=400", "--set",
                                  "mosaic.colour_map=gray", "--set", "mosaic.width=" + std::to_string(2 * half_width)});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        notices_ = outcome.err;
        picture_ = cv::imread((folder / "out/mosaic_000001.png").string(), cv::IMREAD_GRAYSCALE);
    }
    void SetUp() override { ASSERT_EQ(picture_.cols, 2 * half_width); }

    double pixelsPerBin() const { return layout_.radius() / 120; }
    cv::Point2d onMap(double north, double west) const {
        const double scale = layout_.radius() / layout_.range();
        return layout_.origin() + cv::Point2d(half_width, 0) - scale * cv::Point2d(west - 1.5, north - 1.7);
    }
    cv::Rect part(double north, double west, double south, double east) const {
        return {cv::Point(onMap(north, west)), cv::Point(onMap(south, east))};
    }
    void expectStraight(const cv::Mat& picture, cv::Rect wall, double at, const char* name) {
        const test::LineFit fit(test::ridge(picture, wall, 6));
        RecordProperty(name, std::to_string(fit.farthest / pixelsPerBin()));
        EXPECT_LT(fit.farthest, pixelsPerBin()) << name;
        EXPECT_NEAR(fit.middle.y, at, 1.5 * pixelsPerBin()) << name;
    }

    static inline cv::Mat picture_;
    static inline std::string notices_;
    const output::FanLayout layout_{half_width, -std::numbers::pi, std::numbers::pi, 24};
};

}  // namespace

TEST_F(MosaicRunTest, WallsAreStraightWithinOneBinWhereEachPingHasItsPose) {
    for (const double side : {1.0, -1.0}) {
        const double north = side * 13.2, west = side * 9;
        expectStraight(picture_, part(north + 1.5, 6, north - 1.5, -6), onMap(north, 0).y,
                       side > 0 ? "north_bins" : "south_bins");
        const cv::Rect upright = part(8, west + 1.5, -8, west - 1.5);
        expectStraight(picture_.t(), {upright.y, upright.x, upright.height, upright.width}, onMap(0, west).x,
                       side > 0 ? "west_bins" : "east_bins");
    }
}

TEST_F(MosaicRunTest, OnAPolarDiscWallsBendByMoreThanTenBins) {
    std::vector<cv::Point2d> received;
    for (double bearing = -155; bearing < -83; bearing += 0.9)
        for (double range = 3; range < 23; range += 0.05) {
            const double length = range / layout_.range() * layout_.radius(), angle = types::radians(bearing);
            const cv::Point2d at = layout_.origin() - length * cv::Point2d(std::sin(angle), std::cos(angle));
            if (picture_.at<uint8_t>(cvRound(at.y), cvRound(at.x)) < 150) continue;
            received.push_back(at);
            break;
        }
    const test::LineFit fit(received);
    RecordProperty("disc_bins", std::to_string(fit.farthest / pixelsPerBin()));
    EXPECT_GT(fit.farthest, 10 * pixelsPerBin());
}

TEST_F(MosaicRunTest, EveryPingHasAnInterpolatedPose) {
    EXPECT_EQ(notices_.find("held"), std::string::npos) << notices_;
}

TEST_F(MosaicRunTest, ReportsAHeldPoseAtTheEndOfTheRun) {
    const deployer::TestFolder folder;
    const fs::path deployment = fs::path(test::source_dir) / "deploy/tank_mosaic.yml";
    const Outcome outcome = callInsonify(folder, {"run", deployment, "--out", "out", "--pings", "2"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("warning: mosaic: each ping at its pose, north up: 2 pings, 1 at a pose held for "
                               "up to 0.05 s"),
              std::string::npos)
        << outcome.err;
}
