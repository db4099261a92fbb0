#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "components/sonar/tasks/PingTask.hpp"
#include "tests/sonar/WallScene.hpp"
#include "tests/support/TaskBench.hpp"

namespace insonify::sonar {
namespace {

using framework::TaskState;

struct SonarTaskTest : test::TaskBench<SonarTask, types::SnapshotPtr, types::SonarPtr> {
    SonarTaskTest() : TaskBench(&SonarTask::snapshot, &SonarTask::ping) {}
    void start(const SonarConfig& config = smallSonar()) { startWith(config); }
    /** Returns the ping of one snapshot; null without a ping. */
    types::SonarPtr makePing(types::Snapshot snapshot) {
        return answerTo(std::make_shared<types::Snapshot>(std::move(snapshot)));
    }
};

TEST_F(SonarTaskTest, APingCarriesTheTimeOfItsSnapshotAndTheGridOfItsBins) {
    start();
    const auto ping = makePing(facingWall(5));
    ASSERT_TRUE(ping) << task_.lastError();
    EXPECT_EQ(ping->time, types::Time{7'000'000});
    EXPECT_EQ(ping->beam_count, 8u);
    EXPECT_EQ(ping->bin_count, 100u);
    EXPECT_EQ(ping->bins.size(), 800u);
    EXPECT_EQ(ping->bin_duration.microseconds, 100);
    EXPECT_NEAR(ping->bearings[0].deg(), -35, 1e-9);
    EXPECT_NEAR(ping->beam_width.deg(), 10, 1e-9);
    EXPECT_NEAR(firstEcho(*ping, 4), 5, 0.16);
    ASSERT_TRUE(task_.plan());
    EXPECT_THAT(task_.plan()->features, ::testing::Contains("physical"));
    EXPECT_EQ(task_.stages().count("draw"), 1u);
}

/** Beams of 10 deg with the same spacing, and the same bearings with beams of 20 deg. Each wide beam receives the
 *  echoes of the narrow beam and half of both neighbours. */
TEST_F(SonarTaskTest, ABeamWiderThanItsSpacingReceivesItsNeighboursEchoes) {
    const auto energies = [&](std::optional<double> width) {
        SonarConfig config = smallSonar();
        config.beam_width_deg = width;
        config.quality.columns_per_beam = width ? 32 : 16;
        task_.stop();
        task_.cleanup();
        start(config);
        const auto ping = makePing(facingWall(5));
        EXPECT_EQ(ping->beam_count, 8u);
        EXPECT_NEAR(ping->bearings[3].deg(), -5, 1e-9);
        EXPECT_NEAR(ping->beam_width.deg(), width.value_or(10), 1e-6);
        std::vector<double> sums;
        for (uint32_t beam = 0; beam < 8; ++beam)
            sums.push_back(
                std::accumulate(ping->bins.begin() + beam * 100, ping->bins.begin() + (beam + 1) * 100, 0.0));
        return sums;
    };
    const std::vector<double> narrow = energies({}), wide = energies(20);
    for (size_t k = 2; k < 6; ++k)
        EXPECT_NEAR(wide[k] / (narrow[k] + narrow[k - 1] / 2 + narrow[k + 1] / 2), 1, 0.05) << k;
}

TEST_F(SonarTaskTest, AnInvalidPoseIsARunTimeErrorUntilTheNextValidPose) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    start();
    types::Snapshot lost = facingWall(5), unturned = facingWall(5), spun = facingWall(5), empty = facingWall(5),
                    strange = facingWall(5);
    lost.sonar.position.x = nan;
    unturned.sonar.orientation = {0, 0, 0, 1e-7};
    spun.sonar.orientation.w = nan;
    empty.geometry = nullptr;
    strange.moved.push_back({static_cast<uint32_t>(strange.geometry->objects.size()), glm::dmat4(1)});
    for (const types::Snapshot& bad : {lost, unturned, spun, empty, strange}) {
        EXPECT_FALSE(makePing(bad));
        EXPECT_EQ(task_.state(), TaskState::RunTimeError);
        EXPECT_FALSE(task_.lastError().empty());
        EXPECT_TRUE(makePing(facingWall(5)));
        EXPECT_EQ(task_.state(), TaskState::Running);
    }
}

TEST_F(SonarTaskTest, AQuaternionThatIsNotOfUnitLengthIsNormalised) {
    start();
    const auto ping = makePing(facingWall(5));
    types::Snapshot longer = facingWall(5);
    longer.sonar.orientation *= 1.001;
    const auto same = makePing(longer);
    ASSERT_TRUE(ping && same);
    EXPECT_EQ(ping->bins, same->bins);
}

TEST_F(SonarTaskTest, ReportsAmbiguousPingsCloserThanTheTwoWayTravelTime) {
    const auto warning = ::testing::Contains(::testing::HasSubstr("ambiguous in range"));
    const auto pingAt = [&](double seconds) {
        types::Snapshot snapshot = facingWall(5);
        snapshot.time = types::Time::fromSeconds(seconds);
        return makePing(snapshot);
    };
    start();  // 15 m there and back at 1500 m/s: 20 ms
    ASSERT_TRUE(pingAt(1) && pingAt(1.1));
    EXPECT_THAT(task_.notices(), ::testing::Not(warning));
    ASSERT_TRUE(pingAt(1.101)) << "received nevertheless";
    EXPECT_THAT(task_.notices(), warning);
}

TEST_F(SonarTaskTest, AJumpingSonarPingsFromItsNewPlaceAndWarnsOnce) {
    std::vector<std::string> jumps;
    task_.environment().warn = [&](const std::string& text) {
        if (text.find("the sonar has moved") != std::string::npos) jumps.push_back(text);
    };
    double seconds = 0;
    const auto pingAt = [&](double y) {
        types::Snapshot snapshot = facingWall(5);
        snapshot.time = types::Time::fromSeconds(seconds += 1);
        snapshot.sonar.position.y = y;
        return makePing(snapshot);
    };
    start();
    const auto first = pingAt(0);
    ASSERT_TRUE(first && pingAt(140));
    EXPECT_THAT(jumps, ::testing::IsEmpty());
    for (const double far : {300.0, 3e3, 1e9, 1e30, 1e300, -1e300, std::numeric_limits<double>::max(), 0.0}) {
        const auto ping = pingAt(far);
        ASSERT_TRUE(ping) << far << ": " << task_.lastError();
        EXPECT_TRUE(std::ranges::all_of(ping->bins, [](float bin) { return std::isfinite(bin); })) << far;
        EXPECT_EQ(ping->bins == first->bins, far == 0) << "as if it had never been away";
    }
    EXPECT_THAT(jumps,
                ::testing::ElementsAre("task: the sonar has moved 160 m in 1 s, faster than a tenth of the speed "
                                       "of sound, 150 m/s: it counts as repositioned, at rest unless its pose "
                                       "has a velocity"));
    for (int i = 0; i < 10; ++i) pingAt(0);
    pingAt(200);
    EXPECT_EQ(jumps.size(), 2u);
}

TEST_F(SonarTaskTest, TheJumpOfALoopingTrajectoryIsReportedOnce) {
    std::vector<std::string> jumps;
    task_.environment().warn = [&](const std::string& text) {
        if (text.find("the sonar has moved") != std::string::npos) jumps.push_back(text);
    };
    double seconds = 0;
    const auto pingAt = [&](double y) {
        types::Snapshot snapshot = facingWall(5);
        snapshot.time = types::Time::fromSeconds(seconds += 0.1);
        snapshot.sonar.position.y = y;
        return makePing(snapshot);
    };
    start();
    for (int turn = 0; turn < 5; ++turn)  // back by 20 m in 0.1 s, each turn at another phase
        for (int i = 0; i < 20; ++i) pingAt(i + 0.13 * turn);
    EXPECT_EQ(jumps.size(), 1u);
    for (int i = 0; i < 20; ++i) pingAt(19 - i);
    pingAt(500);
    EXPECT_EQ(jumps.size(), 2u) << "another jump";
}

TEST_F(SonarTaskTest, ANewSceneIsRenderedFromTheNextPing) {
    start();
    EXPECT_NEAR(firstEcho(*makePing(facingWall(5)), 4), 5, 0.16);
    EXPECT_NEAR(firstEcho(*makePing(facingWall(9)), 4), 9, 0.16);
}

TEST_F(SonarTaskTest, CanBeCleanedUpAndConfiguredAgain) {
    start();
    ASSERT_TRUE(makePing(facingWall(5)));
    ASSERT_TRUE(task_.stop());
    ASSERT_TRUE(task_.cleanup());
    SonarConfig config = smallSonar();
    config.beam_count = 4;
    start(config);
    EXPECT_EQ(makePing(facingWall(5))->beam_count, 4u);
}

TEST_F(SonarTaskTest, NoticesAreThoseOfTheConfigurationUntilTheSceneIsKnown) {
    SonarConfig config = smallSonar();
    config.speed_of_sound = 1700;
    start(config);
    EXPECT_THAT(task_.notices(), ::testing::Contains(::testing::HasSubstr("speed of sound is 1700 m/s")));
    ASSERT_TRUE(makePing(facingWall(5)));
    EXPECT_THAT(task_.notices(), ::testing::Contains(::testing::HasSubstr("medium sand")));
}

TEST_F(SonarTaskTest, AChangedPropertyAppliesFromTheNextPing) {
    const auto set = [&](const char* setter, const char* value) { task_.operation(setter)->callText({value}); };
    start();
    ASSERT_TRUE(makePing(facingWall(5)));
    set("setBin_count", "50");
    set("setRange", "10");
    auto ping = makePing(facingWall(5));
    ASSERT_TRUE(ping) << task_.lastError();
    EXPECT_EQ(ping->bin_count, 50u);
    EXPECT_NEAR(ping->binStart(50), 10, 0.1);
    EXPECT_NEAR(firstEcho(*ping, 4), 5, 0.2);
    EXPECT_THROW(set("setRange", "-1"), types::ConfigError);
    EXPECT_THROW(set("setMultipath", "{bounces: 3}"), types::ConfigError);
    EXPECT_EQ(task_.config->range, 10);
    EXPECT_EQ(task_.state(), TaskState::Running);
}

}  // namespace
}  // namespace insonify::sonar
