#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "components/sonar/Quality.hpp"
#include "components/sonar/SonarTask.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Scenes.hpp"

namespace insonify::sonar {
namespace {

constexpr double forever = std::numeric_limits<double>::infinity();

SonarConfig small() {
    SonarConfig config;
    config.range = 30;
    config.bin_count = 300;
    config.beam_count = 16;
    config.field_of_view_deg = 60;
    config.device = "software";
    return config;
}

const std::vector<Quality> ladder = {{8, 1, 0.3, 1}, {16, 1, 0.1, 2}, {16, 2, 0.05, 4}};

TEST(TryQualitiesTest, EachStepDoublesRowsOrColumnsAndTheLastReachesTheTarget) {
    const auto geometry = test::sceneOf({test::ground(-3), test::sphere(1, 32)}, -10, {{0, 0, 0}, {12, 2, -2}});
    const auto steps = tryQualities(small(), test::snapshotOf(geometry), 0.03, forever);
    ASSERT_GT(steps.size(), 2u);
    for (size_t i = 1; i < steps.size(); ++i)
        EXPECT_EQ(steps[i].rows * steps[i].columns_per_beam, 2 * steps[i - 1].rows * steps[i - 1].columns_per_beam);
    EXPECT_LE(steps.back().error, 0.03);
    EXPECT_GT(steps[steps.size() - 2].error, 0.03);
}

TEST(TryQualitiesTest, AnEmptySeaIsWithoutErrorAtOnce) {
    const auto steps = tryQualities(small(), test::snapshotOf(test::sceneOf({test::ground(500)})), 0.03, forever);
    ASSERT_EQ(steps.size(), 1u);
    EXPECT_EQ(steps[0].error, 0);
}

TEST(TryQualitiesTest, ABudgetEndsTheLadderBeforeItIsSpent) {
    const auto geometry = test::sceneOf({test::ground(-3)}, -10);
    const auto steps = tryQualities(small(), test::snapshotOf(geometry), 0, 1e-6);
    ASSERT_EQ(steps.size(), 1u) << "the coarsest, which there must be";
    EXPECT_GT(steps[0].ms, 1e-6);
}

TEST(BudgetKeeperTest, TwoOfTwentyPingsNearTheBudgetLowerTheQuality) {
    BudgetKeeper keeper(ladder, 10);
    EXPECT_EQ(keeper.quality().columns_per_beam, 2);
    EXPECT_FALSE(keeper.heard(11));
    for (int i = 0; i < 30; ++i) EXPECT_FALSE(keeper.heard(8)) << "one late ping is forgotten";
    EXPECT_FALSE(keeper.heard(9));
    EXPECT_TRUE(keeper.heard(9)) << "before the budget is overrun";
    EXPECT_EQ(keeper.quality().rows, 16);
    EXPECT_EQ(keeper.quality().columns_per_beam, 1);
}

TEST(BudgetKeeperTest, AHundredEarlyPingsRaiseItAgain) {
    BudgetKeeper keeper(ladder, 10);
    keeper.heard(11);
    keeper.heard(11);
    for (int i = 0; i < 99; ++i) EXPECT_FALSE(keeper.heard(1));
    EXPECT_FALSE(keeper.heard(4)) << "the next would take 8: not a hundred in a row";
    for (int i = 0; i < 99; ++i) EXPECT_FALSE(keeper.heard(3));
    EXPECT_TRUE(keeper.heard(3)) << "the next takes twice as long: 6 of 10";
    EXPECT_EQ(keeper.quality().columns_per_beam, 2);
}

TEST(BudgetKeeperTest, TheLadderHasTwoEnds) {
    BudgetKeeper keeper(ladder, 10);
    for (int i = 0; i < 50; ++i) keeper.heard(11);
    EXPECT_EQ(keeper.quality().rows, 8);
    EXPECT_FALSE(keeper.heard(11) || keeper.heard(11));
    for (int i = 0; i < 500; ++i) keeper.heard(0.1);
    EXPECT_EQ(keeper.quality().columns_per_beam, 2);
}

TEST(QualityTaskTest, TheChoiceAndItsErrorAreInThePlanOnceSomethingIsHeard) {
    SonarTask task("sonar");
    test::Writer<types::SnapshotPtr> in;
    in.port.connectTo(task.snapshot, framework::ConnPolicy::buffer(4));
    SonarConfig config = small();
    config.quality.target_error = 0.03;
    task.config.set(config);
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    const auto geometry = test::sceneOf({test::ground(-3)}, -10);
    const auto ping = [&](double height) {
        auto snapshot = test::snapshotOf(geometry, {0, 0, height});
        in.port.write(std::make_shared<types::Snapshot>(snapshot));
        task.update();
    };
    ping(300);
    ASSERT_TRUE(task.plan()) << task.lastError();
    EXPECT_TRUE(std::isnan(task.plan()->predicted_error)) << "nothing is in range";
    EXPECT_EQ(task.plan()->rows, SonarConfig().rows());
    ping(0);
    EXPECT_GT(task.plan()->predicted_error, 0);
    EXPECT_LE(task.plan()->predicted_error, 0.03);
    EXPECT_LT(task.plan()->rows, SonarConfig().rows()) << "a flat bottom needs few";
}

TEST(QualityBudgetTest, ABudgetThatIsTooSmallLeadsToTheCoarsest) {
    SonarTask task("sonar");
    test::Writer<types::SnapshotPtr> in;
    in.port.connectTo(task.snapshot, framework::ConnPolicy::buffer(4));
    SonarConfig config = small();
    config.quality.budget_ms = 0.1;  // less than the first context switch
    config.bin_count = 20000;
    task.config.set(config);
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    const auto geometry = test::sceneOf({test::ground(-3)}, -10);
    for (int i = 0; i < 3; ++i) {
        in.port.write(std::make_shared<types::Snapshot>(test::snapshotOf(geometry)));
        task.update();
    }
    ASSERT_TRUE(task.plan()) << task.lastError();
    EXPECT_EQ(task.plan()->rows, 8);
    EXPECT_GT(task.plan()->predicted_error, 0);
    EXPECT_THAT(task.notices(), testing::Contains(testing::HasSubstr("the coarsest quality takes")));
}

TEST(CulledTest, ThePlanSaysWhatOfTheSceneIsNotDrawn) {
    SonarTask task("sonar");
    test::Writer<types::SnapshotPtr> in;
    in.port.connectTo(task.snapshot, framework::ConnPolicy::buffer(4));
    SonarConfig config = small();
    config.field_of_view_deg = 180;  // three slabs
    task.config.set(config);
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    const types::Mesh ball = test::sphere(0.5, 8);
    const auto geometry = test::sceneOf({ball, ball, ball}, -10, {{10, 0, 0}, {-10, 0, 0}, {200, 0, 0}});
    in.port.write(std::make_shared<types::Snapshot>(test::snapshotOf(geometry)));
    task.update();
    ASSERT_TRUE(task.plan()) << task.lastError();
    std::vector<std::string> names;
    for (const types::Omission& omission : task.plan()->omitted) names.push_back(omission.name);
    EXPECT_THAT(names, testing::IsSupersetOf({"2 of 3 objects", "2 of 3 slabs"}));
    const size_t each = ball.indices.size() / 3;
    EXPECT_THAT(names, testing::Contains("at least " + std::to_string(2 * each) + " of " + std::to_string(3 * each) +
                                         " triangles"));
}

}  // namespace
}  // namespace insonify::sonar
