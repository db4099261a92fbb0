#include <gmock/gmock.h>

#include <cmath>

#include "components/dataset/Sweep.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/Hash.hpp"

namespace insonify::dataset {
namespace {

using ::testing::ElementsAre;

Axis drawnFrom(std::vector<double> uniform, std::vector<double> normal) {
    Axis axis;
    axis.uniform = std::move(uniform);
    axis.normal = std::move(normal);
    return axis;
}

std::vector<double> getSteps(const Axis& axis) {
    std::vector<double> steps;
    for (uint64_t i = 0; i < axis.stepCount(); ++i) steps.push_back(axis.step(i));
    return steps;
}

TEST(SweepTest, StepsGoEvenlyFromOneValueToTheOther) {
    Axis axis;
    EXPECT_THAT(getSteps(axis), ElementsAre(0));
    axis.from = -1, axis.to = 1, axis.count = 3;
    EXPECT_THAT(getSteps(axis), ElementsAre(-1, 0, 1));
    axis.count = 1;
    EXPECT_THAT(getSteps(axis), ElementsAre(-1));
    axis = {};
    axis.values = {4, 2};
    EXPECT_THAT(getSteps(axis), ElementsAre(4, 2));
}

TEST(SweepTest, AHugeGridDoesNotOverflow) {
    PoseAxes axes;
    PoseAxes::forEach(axes,
                      [](const char*, const char*, Axis& axis) { axis.from = 0, axis.to = 1, axis.count = 1000000; });
    EXPECT_EQ(axes.gridSize(), 1000000000000u);
}

TEST(SweepTest, DrawnValuesFollowTheirLaw) {
    const Axis uniform = drawnFrom({2, 4}, {}), normal = drawnFrom({}, {-5, 0.5});
    double sum = 0, squares = 0, lowest = 1e9, highest = -1e9, mean_of_uniform = 0;
    constexpr int count = 20000;
    for (int i = 0; i < count; ++i) {
        const uint64_t word = types::hashed(7, static_cast<uint64_t>(i), 1);
        const double u = uniform.draw(word), n = normal.draw(word);
        lowest = std::min(lowest, u), highest = std::max(highest, u), mean_of_uniform += u / count;
        sum += n, squares += (n + 5) * (n + 5);
        EXPECT_EQ(u, std::round(u * 1e6) / 1e6) << i;
    }
    EXPECT_GE(lowest, 2);
    EXPECT_LE(highest, 4);
    EXPECT_NEAR(mean_of_uniform, 3, 5 * 0.577 / std::sqrt(count));
    EXPECT_NEAR(sum / count, -5, 5 * 0.5 / std::sqrt(count));
    EXPECT_NEAR(squares / count, 0.25, 5 * 0.25 * std::sqrt(2.0 / count));
}

TEST(SweepTest, APartDependsOnTheNumberAlone) {
    Split split;
    EXPECT_EQ(split.of(1, 12), Part::Train);
    split.train = 0.7, split.val = 0.2, split.test = 0.1;
    std::array<int, 3> counts{};
    for (uint64_t index = 0; index < 10000; ++index) ++counts[static_cast<size_t>(split.of(3, index))];
    EXPECT_NEAR(counts[0], 7000, 5 * std::sqrt(10000 * 0.7 * 0.3));
    EXPECT_NEAR(counts[1], 2000, 5 * std::sqrt(10000 * 0.2 * 0.8));
    EXPECT_NEAR(counts[2], 1000, 5 * std::sqrt(10000 * 0.1 * 0.9));
    split.train = 0, split.val = 0, split.test = 1;
    EXPECT_EQ(split.of(1, 12), Part::Test);
}

TEST(SweepTest, AStarMatchesAnyLetters) {
    EXPECT_TRUE(matches("pile_*", "pile_07"));
    EXPECT_TRUE(matches("*", ""));
    EXPECT_TRUE(matches("*rock*a", "big_rock_rock_a"));
    EXPECT_FALSE(matches("pile_*", "spile_07"));
    EXPECT_FALSE(matches("*rock*a", "big_rock_b"));
    EXPECT_FALSE(matches("pile", "pile_07"));
    EXPECT_FALSE(matches("", "a"));
}

TEST(SweepTest, RefusesContradictoryKeys) {
    EXPECT_THAT(test::countRefusals(Axis{}), testing::SizeIs(1));
    Axis axis = drawnFrom({4, 2}, {});
    EXPECT_THAT(test::countRefusals(axis), ElementsAre("uniform: must be [min, max], the min not above the max"));
    axis = drawnFrom({}, {1, -1});
    EXPECT_THAT(test::countRefusals(axis),
                ElementsAre("normal: must be two numbers, [mean, deviation], the deviation not below 0"));
    axis = {};
    axis.from = 1;
    EXPECT_THAT(test::countRefusals(axis), ElementsAre("needs all of from, to and count for steps"));
    Split split;
    split.val = 0.2;
    EXPECT_THAT(test::countRefusals(split), ElementsAre("adds up to 1.2; train, val and test must add up to 1"));
    ObjectGroup group;
    group.names = {"a"};
    group.x = {0, 1};
    EXPECT_THAT(test::countRefusals(group), ElementsAre("y: is missing; give [min, max]"));
    TrajectoryPoses poses;
    poses.file = "a.csv";
    EXPECT_THAT(test::countRefusals(poses),
                ElementsAre("must have one of count and period, which set the number of poses"));
}

}  // namespace
}  // namespace insonify::dataset
