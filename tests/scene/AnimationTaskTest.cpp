// A scene's task plays animations by the time of poses, or by a port.
#include <gmock/gmock.h>

#include "tests/scene/AnimatedFiles.hpp"
#include "tests/scene/SceneTaskFiles.hpp"
#include "tests/support/Allocations.hpp"

namespace insonify::scene {
namespace {

struct AnimationTaskTest : SceneTaskFiles {
    AnimationTaskTest() : SceneTaskFiles(eelText(Tube(5, 6, 0.1f))) {
        environment_->now = [this] { return now_; };
        environment_->start_time = [] { return types::Time::fromSeconds(1); };
        task_.setEnvironment(environment_);
    }
    /** The snapshot at a time after the start of the run [s]. */
    types::SnapshotPtr snapshotAt(double seconds) {
        now_ = types::Time::fromSeconds(1 + seconds);
        return ping(at(1 + seconds, {0, 0, 0}));
    }
    /** How far the eel has gone along x [m]; none where nothing moves it. */
    std::optional<double> wayAt(double seconds) {
        const types::SnapshotPtr snapshot = snapshotAt(seconds);
        if (snapshot->moved.empty()) return {};
        return snapshot->moved[0].world_from_object[3].x;
    }

    types::Time now_ = types::Time::fromSeconds(1);
    std::shared_ptr<framework::Environment> environment_ = std::make_shared<framework::Environment>();
    test::Writer<types::Pose> eel_{"eel"};
    test::Writer<double> clock_{"clock"};
};

TEST_F(AnimationTaskTest, AllAnimationsPlayFromTheStartOfTheRun) {
    start();
    EXPECT_NEAR(*wayAt(0), 0, 1e-12);
    EXPECT_NEAR(*wayAt(1.5), 0.75, 1e-12);
    EXPECT_NEAR(*wayAt(2.5), 0.25, 1e-12);
    EXPECT_EQ(snapshotAt(0.5)->deformed.size(), 1u);
    EXPECT_THAT(task_.notices(),
                testing::Contains(testing::HasSubstr("animations that play: waves (1 s), advance (2 s)")));
}

TEST_F(AnimationTaskTest, AnimationsThatAreNotToPlayLeaveTheSceneAtRest) {
    config_.animations["*"].play = false;
    start();
    const types::SnapshotPtr snapshot = snapshotAt(0.5);
    EXPECT_TRUE(snapshot->moved.empty());
    EXPECT_TRUE(snapshot->deformed.empty());
    EXPECT_TRUE(snapshot->joints.empty());
}

TEST_F(AnimationTaskTest, APortSetsTheTimeWithinAnAnimation) {
    task_.config.set(config_);
    auto* const port = task_.makeInput("advance.time", clock_.port);
    ASSERT_NE(port, nullptr);
    EXPECT_EQ(port->need(), framework::Need::Optional);
    EXPECT_EQ(task_.makeInput("runs.time", clock_.port), nullptr);
    ASSERT_TRUE(clock_.port.connectTo(*port, {}));
    start();
    EXPECT_NEAR(*wayAt(0.5), 0.25, 1e-12);  // the time of the run, before the port has one
    clock_.port.write(1.0);
    EXPECT_NEAR(*wayAt(0.6), 0.5, 1e-12);
    EXPECT_NEAR(*wayAt(0.7), 0.5, 1e-12);  // the newest stays
    clock_.port.write(1.2);
    const types::SnapshotPtr snapshot = snapshotAt(0.8);
    EXPECT_NEAR(snapshot->moved[0].world_from_object[3].x, 0.6, 1e-12);
    EXPECT_NEAR((*snapshot->moved[0].rate)[3].x, 0.5 * 0.2 / 0.2, 1e-9);  // 0.2 s of it within 0.2 s
    clock_.port.write(std::numeric_limits<double>::quiet_NaN());
    EXPECT_NEAR(*wayAt(0.9), 0.6, 1e-12);
    ASSERT_TRUE(task_.stop());
    ASSERT_TRUE(task_.start());
    EXPECT_NEAR(*wayAt(0.5), 0.25, 1e-12);
}

TEST_F(AnimationTaskTest, APoseMovesANodeInPlaceOfItsAnimation) {
    task_.config.set(config_);
    eel_.port.connectTo(*task_.makeInput("eel.pose", eel_.port), {});
    start();
    EXPECT_NEAR(*wayAt(0.5), 0.25, 1e-12);
    types::Pose pose;
    pose.time = now_;
    pose.position = {50, 0, 0};
    pose.orientation = {1, 0, 0, 0};
    eel_.port.write(pose);
    EXPECT_NEAR(*wayAt(0.6), 50, 1e-12);
    EXPECT_EQ(snapshotAt(0.7)->deformed.size(), 1u);
}

TEST_F(AnimationTaskTest, ATargetMovesWithAnAnimatedNode) {
    TargetConfig target;
    target.name = "tag";
    target.attached_to = "eel";
    target.position = {0, 0, 2};
    target.strength_db = -30;
    config_.targets = {target};
    start();
    EXPECT_LT(glm::distance(snapshotAt(1)->targets.at(0).position, glm::dvec3(0.5, 0, 2.125)), 1e-12);
}

TEST_F(AnimationTaskTest, AnUnknownAnimationIsRefused) {
    config_.animations["advanse"].speed = 2;
    task_.config.set(config_);
    types::Diagnostics diagnostics;
    task_.check(diagnostics);
    ASSERT_EQ(diagnostics.size(), 1u);
    EXPECT_EQ(diagnostics[0].path, "animations.advanse");
    EXPECT_THAT(diagnostics[0].message, testing::HasSubstr("did you mean"));
    EXPECT_THAT(diagnostics[0].message, testing::HasSubstr("may be waves, advance"));
}

TEST_F(AnimationTaskTest, AnimationsAllocateNothingAfterTheFirstPoses) {
    task_.config.set(config_);
    eel_.port.connectTo(*task_.makeInput("eel.pose", eel_.port), {});
    start();
    types::SnapshotPtr last = snapshotAt(0);
    EXPECT_THAT(test::allocationsOn(task_,
                                    [&] {
                                        for (int i = 1; i < 100; ++i) last = snapshotAt(0.05 * i);
                                    }),
                testing::IsEmpty());
    EXPECT_EQ(last->deformed.size(), 1u);
}

}  // namespace
}  // namespace insonify::scene
