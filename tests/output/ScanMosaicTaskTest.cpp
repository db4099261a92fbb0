#include <gmock/gmock.h>

#include "components/output/tasks/PairPictureTask.hpp"
#include "tests/output/PictureBench.hpp"
#include "tests/output/Room.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::output {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/** Checks where the task shows an echo 10 m straight ahead. */
struct ScanMosaicTaskTest : test::PictureBench<ScanMosaicTask, types::Pose> {
    ScanMosaicTaskTest() : PictureBench(&ScanMosaicTask::pose) {
        MosaicConfig config;
        config.width = 1200;
        config.reference_db = 0;
        config.colour_map = ColourMap::Gray;
        config.timeout = 0.5;
        config.mount.position = {1, 0, 0};
        task_.config.set(config);
    }
    void givePose(double seconds, double north, double yaw_deg = 0) {
        types::Pose pose;
        pose.time = types::Time::fromSeconds(seconds);
        pose.position.x = north;
        pose.orientation = glm::angleAxis(types::radians(yaw_deg), glm::dvec3(0, 0, 1));
        giveSecond(pose);
    }
    void givePing(double seconds) {
        types::Sonar ping = test::withEcho(test::emptyPing(4, 1), 0, 20);
        ping.time = types::Time::fromSeconds(seconds);
        give(ping);
    }
};

TEST_F(ScanMosaicTaskTest, APingWaitsForTheNextPoseAndIsShownAtTheInterpolatedPose) {
    start();
    givePose(1, 0, 0);
    givePing(1.3);
    EXPECT_EQ(pictures(), 0u);
    givePose(2, 10, 90);
    EXPECT_EQ(pictures(), 1u);
    EXPECT_EQ(last_->time, types::Time::fromSeconds(1.3));
    EXPECT_THAT(task_.notices(), IsEmpty());

    // At 3 m north, turned by 27 degrees; the sonar is 1 m ahead of the body.
    types::Pose sonar;
    sonar.orientation = glm::angleAxis(types::radians(27), glm::dvec3(0, 0, 1));
    sonar.position = glm::dvec3(3, 0, 0) + sonar.orientation * glm::dvec3(1, 0, 0);
    ScanMosaic expected(*task_.config);
    expected.place(sonar);
    expected.setCaption("each ping at its pose, north up: 1 pings");
    types::Sonar ping = test::withEcho(test::emptyPing(4, 1), 0, 20);
    ping.time = last_->time;
    types::Image picture;
    expected.paint(ping, picture);
    EXPECT_EQ(cv::norm(test::toPixels(*last_), test::toPixels(picture), cv::NORM_INF), 0);
}

TEST_F(ScanMosaicTaskTest, APoseAtThePingsTimeIsEnough) {
    start();
    givePose(1, 0);
    givePing(1);
    EXPECT_EQ(pictures(), 1u);
    EXPECT_THAT(task_.notices(), IsEmpty());
}

TEST_F(ScanMosaicTaskTest, CountsAndReportsAHeldPose) {
    start();
    givePose(1, 0);
    givePing(1.2);
    givePing(1.6);
    EXPECT_EQ(pictures(), 0u);
    givePing(1.7);
    EXPECT_EQ(pictures(), 1u) << "the ping of 1.2 s has waited for 0.5 s";
    ASSERT_TRUE(task_.stop());
    EXPECT_EQ(pictures(), 2u);
    EXPECT_THAT(
        task_.notices(),
        ElementsAre("pose: samples of other ports handed over without it: 1",
                    types::warning("each ping at its pose, north up: 3 pings, 3 at a pose held for up to 0.7 s")));
}

TEST_F(ScanMosaicTaskTest, UsesTheFirstPoseForEarlierPings) {
    start();
    givePing(0.9);
    givePose(1, 0);
    EXPECT_EQ(pictures(), 1u);
    EXPECT_THAT(task_.notices(), ElementsAre(HasSubstr("1 at a pose held for up to 0.1 s")));
}

TEST_F(ScanMosaicTaskTest, OmitsAndReportsAPingWithoutAUsablePose) {
    start();
    givePing(1);
    givePing(2);
    givePose(3, std::nan(""));
    givePing(3);
    EXPECT_EQ(pictures(), 3u);
    EXPECT_THAT(task_.notices(), testing::Contains(HasSubstr("0 pings, 3 not shown because they have no usable pose")));
}

TEST_F(ScanMosaicTaskTest, ReportsALatePose) {
    start();
    givePing(1);
    givePing(2);
    givePose(0.5, 0);
    EXPECT_THAT(task_.notices(), testing::Contains(HasSubstr("pose: 1 of 1 samples came too late")));
}

TEST_F(ScanMosaicTaskTest, RefusesHalvesThatAreTooNarrow) {
    MosaicConfig config;
    EXPECT_THAT(test::countRefusals(config), IsEmpty());
    config.width = 511;
    EXPECT_THAT(test::countRefusals(config), testing::ElementsAre(testing::StartsWith("width: ")));
}

TEST_F(ScanMosaicTaskTest, ARestartForgetsEarlierPings) {
    start();
    givePing(1);
    ASSERT_TRUE(task_.stop());
    ASSERT_TRUE(task_.start());
    givePose(0.5, 0);
    givePing(0.5);
    EXPECT_THAT(task_.notices(), IsEmpty());
}

TEST_F(ScanMosaicTaskTest, APingBetweenStampsThatWentBackHasTheNearerPose) {
    start();
    givePose(1000, 0);
    givePing(1000.5);
    givePose(1001, 1);
    for (const double time : {400.0, 400.5, 401.0, 1e6, 3.0}) {
        givePing(time);
        givePose(time, 5);
    }
    givePose(4, 6);
    ASSERT_TRUE(task_.stop());
    EXPECT_EQ(pictures(), 6u);
    EXPECT_THAT(task_.notices(), testing::Contains(HasSubstr("stamps went back")));
}

}  // namespace
}  // namespace insonify::output
