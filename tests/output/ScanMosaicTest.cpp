#include <gmock/gmock.h>

#include "components/output/maps/ScanMosaic.hpp"
#include "tests/output/Room.hpp"

namespace insonify::output {
namespace {

/** A mosaic in gray on a fixed scale; 3 pixels a bin. */
struct ScanMosaicTest : ::testing::Test {
    ScanMosaicTest() : mosaic_(test::grayPicture(2 * (2 * 360 + 112))) {}
    void turnInRoom() {
        types::Image picture;
        for (int i = 0; i < test::pings_in_room; ++i) {
            mosaic_.place(test::poseInRoom(static_cast<double>(i) / test::pings_in_room));
            const types::Sonar ping = test::pingInRoom(room_, i);
            i + 1 < test::pings_in_room ? mosaic_.skip(ping) : mosaic_.paint(ping, picture);
        }
        show(picture);
    }
    void show(const types::Image& picture) { cv::cvtColor(test::toPixels(picture), gray_, cv::COLOR_BGR2GRAY); }
    /** Returns the part of the map between two corners in the world. */
    cv::Rect part(glm::dvec2 north_west, glm::dvec2 south_east) const {
        return {cv::Point(mosaic_.pixel(north_west)), cv::Point(mosaic_.pixel(south_east))};
    }
    double pixelsPerBin() const { return test::room_bin * mosaic_.layout().radius() / mosaic_.layout().range(); }
    /** Returns the footprint of a beam along a wall 14 m away that it meets at 45 degrees [px]. */
    int footprint() const { return cvRound(14 * types::radians(0.9) / 0.5 / test::room_bin * pixelsPerBin()); }
    /** Returns the echoes of one wall on the disc, at bearings that see only that wall. */
    std::vector<cv::Point2d> receivedOnDisc(double from_deg, double to_deg) const {
        std::vector<cv::Point2d> points;
        for (double bearing = from_deg; bearing < to_deg; bearing += 0.9)
            for (double range = 3; range < 23; range += 0.05) {
                const cv::Point2d at = mosaic_.layout().pixel(range, types::radians(bearing));
                if (gray_.at<uint8_t>(cvRound(at.y), cvRound(at.x)) < 150) continue;
                points.push_back(at);
                break;
            }
        return points;
    }
    /** Returns the number of columns with an echo east of the middle. */
    size_t brightOnMap() const { return test::ridge(gray_, part({1, -3}, {-1, -20})).size(); }
    int brightAt(glm::dvec2 place) const {
        const cv::Point2d at = mosaic_.pixel(place);
        return gray_.at<uint8_t>(cvRound(at.y), cvRound(at.x));
    }

    test::Room room_;
    ScanMosaic mosaic_;
    cv::Mat gray_;
};

TEST_F(ScanMosaicTest, WallsAreStraightOnTheMapWithinOneBinAndAtTheirPlace) {
    turnInRoom();
    for (const double side : {1.0, -1.0}) {
        const double north = side * room_.north;
        const test::LineFit fit(test::ridge(gray_, part({north + 1.5, 6}, {north - 1.5, -6}), footprint()));
        RecordProperty(side > 0 ? "north_bins" : "south_bins", std::to_string(fit.farthest / pixelsPerBin()));
        EXPECT_LT(fit.farthest, pixelsPerBin());
        EXPECT_NEAR(fit.middle.y, mosaic_.pixel({north, 0}).y, pixelsPerBin());
        EXPECT_NEAR(fit.direction.y / fit.direction.x * 12 / test::room_bin, 0, 1) << "bins over 12 m";

        const double west = side * room_.west;
        const cv::Rect across = part({8, west + 1.5}, {-8, west - 1.5});
        const test::LineFit upright(
            test::ridge(gray_.t(), {across.y, across.x, across.height, across.width}, footprint()));
        RecordProperty(side > 0 ? "west_bins" : "east_bins", std::to_string(upright.farthest / pixelsPerBin()));
        EXPECT_LT(upright.farthest, pixelsPerBin());
        EXPECT_NEAR(upright.middle.y, mosaic_.pixel({0, west}).x, pixelsPerBin());
    }
}

TEST_F(ScanMosaicTest, TheSameWallsBendByMoreThanTenBinsOnTheDisc) {
    turnInRoom();
    // The head sees the western wall again at the end of its turn, from -83 degrees on.
    const test::LineFit fit(receivedOnDisc(-155, -83));
    RecordProperty("disc_bins", std::to_string(fit.farthest / pixelsPerBin()));
    EXPECT_GT(fit.farthest, 10 * pixelsPerBin());
}

TEST_F(ScanMosaicTest, APingWithoutAPoseIsOnlyOnTheDisc) {
    types::Image picture;
    EXPECT_TRUE(mosaic_.place(std::nullopt));
    mosaic_.paint(test::pingInRoom(room_, 300), picture);
    show(picture);
    EXPECT_EQ(receivedOnDisc(-90.4, -89.6).size(), 1u);
    EXPECT_EQ(brightOnMap(), 0u);
    EXPECT_TRUE(mosaic_.place(types::Pose{}));
    mosaic_.paint(test::pingInRoom(room_, 300), picture);
    show(picture);
    EXPECT_GT(brightOnMap(), 0u);
}

TEST_F(ScanMosaicTest, RefusesAnUnusablePose) {
    const auto refused = [&](const auto& spoil) {
        types::Pose pose;
        spoil(pose);
        return !mosaic_.place(pose);
    };
    EXPECT_TRUE(refused([](types::Pose& pose) { pose.position.x = std::nan(""); }));
    EXPECT_TRUE(refused([](types::Pose& pose) { pose.position.z = 1e300; }));
    EXPECT_TRUE(refused([](types::Pose& pose) { pose.orientation = {0, 0, 0, 0}; }));
    EXPECT_TRUE(refused([](types::Pose& pose) { pose.orientation.w = std::nan(""); }));
    EXPECT_FALSE(refused([](types::Pose& pose) { pose.orientation.w = 3; })) << "made one of unit length";
}

TEST_F(ScanMosaicTest, TheMapMovesWithTheSonarAndKeepsCellsWithinIt) {
    types::Pose pose;
    types::Sonar ping = test::pingInRoom(room_, 200);  // straight ahead, 0 degrees
    std::fill(ping.bins.begin(), ping.bins.end(), 0.f);
    ping.bins[50] = 1;
    types::Image picture;
    mosaic_.place(pose);
    mosaic_.paint(ping, picture);
    std::fill(ping.bins.begin(), ping.bins.end(), 0.f);
    ping.bearings[0].rad = std::numbers::pi;
    const glm::dvec2 echo(50.5 * ping.binStart(1), 0);
    for (const glm::dvec2 place : {glm::dvec2(0, 0), glm::dvec2(3.217, -4.71), glm::dvec2(-9, -2)}) {
        pose.position = {place, 0};
        mosaic_.place(pose);
        mosaic_.paint(ping, picture);
        show(picture);
        EXPECT_GT(brightAt(echo), 150) << place.x;
        EXPECT_NEAR(mosaic_.pixel(place).x, mosaic_.layout().origin().x + mosaic_.layout().size().width, 0.51);
    }
    pose.position = {1e8, 1e8, 0};
    mosaic_.place(pose);
    mosaic_.paint(ping, picture);
    pose.position = {0, 0, 0};
    mosaic_.place(pose);
    mosaic_.paint(ping, picture);
    show(picture);
    EXPECT_LT(brightAt(echo), 150) << "it was out of sight in between";
}

TEST_F(ScanMosaicTest, DoesNotMapASonarThatLooksStraightDown) {
    types::Pose pose;
    pose.orientation = glm::angleAxis(std::numbers::pi / 2, glm::dvec3(0, 1, 0));
    types::Image picture;
    EXPECT_FALSE(mosaic_.place(pose));
    mosaic_.paint(test::pingInRoom(room_, 300), picture);
    show(picture);
    EXPECT_EQ(brightOnMap(), 0u);
}

}  // namespace
}  // namespace insonify::output
