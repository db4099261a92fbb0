// Chains of transforms: their results, and their failures.
#include <gmock/gmock.h>

#include <limits>
#include <numbers>

#include "components/ros/TransformTree.hpp"

namespace insonify::ros {
namespace {

using testing::HasSubstr;
using types::Time;

constexpr double half = std::numbers::sqrt2 / 2;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Time at(double seconds) { return Time::fromSeconds(seconds); }

TransformStamped place(const std::string& parent, const std::string& child, Vector3 where, Quaternion turned = {}) {
    return {{{}, parent}, child, {where, turned}};
}

/** A quarter turn to the left, about z. */
constexpr Quaternion left{0, 0, half, half};

struct TransformTreeTest : testing::Test {
    std::string moving(const TransformStamped& transform, double stamp) {
        return tree.add(transform, false, at(stamp), at(stamp));
    }
    std::string fixed(const TransformStamped& transform) { return tree.add(transform, true, {}, at(100)); }
    TransformTree::Found find(double now = 100) const { return tree.newest("map", "base_link", at(now)); }
    void expectAt(double now, double time, glm::dvec3 position) const {
        const auto [placed, diagnostic] = find(now);
        ASSERT_TRUE(placed) << diagnostic;
        EXPECT_EQ(placed->time, at(time));
        EXPECT_LT(glm::distance(placed->position, position), 1e-9)
            << placed->position.x << " " << placed->position.y << " " << placed->position.z;
    }
    TransformTree tree;
};

TEST_F(TransformTreeTest, MultipliesAChainFromTheWorldDown) {
    moving(place("map", "odom", {10, 0, 0}, left), 100);
    moving(place("odom", "base_link", {2, 0, 0}, left), 100);
    expectAt(100, 100, {10, 2, 0});
    const glm::dquat turned = find().placed->orientation;
    EXPECT_LT(glm::distance(turned * glm::dvec3(1, 0, 0), {-1, 0, 0}), 1e-12) << "two quarter turns";
}

TEST_F(TransformTreeTest, UsesTheNewestTimeOfTheSlowestLinkAndInterpolatesOthers) {
    moving(place("map", "odom", {0, 0, 0}), 100);
    moving(place("map", "odom", {10, 0, 0}, left), 101);
    moving(place("odom", "base_link", {4, 0, 0}), 100.25);
    const double a = std::numbers::pi / 8;
    expectAt(101, 100.25, {2.5 + 4 * std::cos(a), 4 * std::sin(a), 0});
    moving(place("odom", "base_link", {0, 0, 0}), 102);
    expectAt(102, 101, {10, 4 * (1 - 0.75 / 1.75), 0});
}

TEST_F(TransformTreeTest, MixesStaticAndMovingLinks) {
    fixed(place("map", "pool", {100, 0, 0}, left));
    moving(place("pool", "tracked", {5, 0, 0}), 100);
    fixed(place("tracked", "base_link", {0, 0, -1}));
    expectAt(100, 100, {100, 5, -1});
    fixed(place("tracked", "base_link", {0, 0, -2}));
    expectAt(100, 100, {100, 5, -2});
}

TEST_F(TransformTreeTest, AStaticChainHasNoTime) {
    fixed(place("map", "pier", {1, 0, 0}));
    fixed(place("pier", "base_link", {1, 0, 0}));
    expectAt(100, 0, {2, 0, 0});
}

TEST_F(TransformTreeTest, TheWorldNeedNotBeTheRoot) {
    moving(place("earth", "map", {1000, 0, 0}, left), 100);
    moving(place("earth", "base_link", {1000, 7, 0}), 100);
    expectAt(100, 100, {7, 0, 0});
    tree = {};
    moving(place("base_link", "map", {3, 0, 0}, left), 100);  // published in the reverse direction
    expectAt(100, 100, {0, 3, 0});
}

TEST_F(TransformTreeTest, IgnoresSlashesBeforeNames) {
    moving(place("/map", "/base_link", {1, 2, 3}), 100);
    expectAt(100, 100, {1, 2, 3});
}

TEST_F(TransformTreeTest, ReportsWhereAChainWithAMissingParentEnds) {
    EXPECT_EQ(find().diagnostic, "no transforms lead from base_link to map");
    moving(place("odom", "base_link", {1, 0, 0}), 100);
    EXPECT_EQ(find().diagnostic, "no transforms lead from base_link to map, only to odom");
    EXPECT_FALSE(find().placed);
    moving(place("map", "odom", {1, 0, 0}), 100);
    expectAt(100, 100, {2, 0, 0});
}

TEST_F(TransformTreeTest, ReportsACircle) {
    moving(place("a", "base_link", {1, 0, 0}), 100);
    moving(place("b", "a", {1, 0, 0}), 100);
    moving(place("a", "b", {1, 0, 0}), 100);
    EXPECT_EQ(find().diagnostic, "the parents of base_link form a circle");
    EXPECT_THAT(moving(place("a", "a", {1, 0, 0}), 100), HasSubstr("a is its own parent"));
}

TEST_F(TransformTreeTest, ReportsWhereAChainIsInterrupted) {
    moving(place("map", "odom", {1, 0, 0}), 100);
    moving(place("odom", "base_link", {1, 0, 0}), 100);
    moving(place("odom", "base_link", {2, 0, 0}), 101.5);
    expectAt(101.5, 100, {2, 0, 0});
    EXPECT_EQ(find(101.5).diagnostic, "odom in map was not published for a second");
    moving(place("map", "odom", {1, 0, 0}), 101.5);
    expectAt(101.5, 101.5, {3, 0, 0});
    EXPECT_EQ(find(101.5).diagnostic, "");
}

TEST_F(TransformTreeTest, HasNoPoseBeforeALinkBegan) {
    moving(place("map", "odom", {1, 0, 0}), 100);
    moving(place("odom", "base_link", {1, 0, 0}), 100.5);
    EXPECT_FALSE(find().placed);
    EXPECT_EQ(find().diagnostic, "odom in map is stamped before all kept transforms of the others");
    moving(place("map", "odom", {1, 0, 0}), 101);
    expectAt(101, 100.5, {2, 0, 0});
}

TEST_F(TransformTreeTest, RefusesNumbersThatAreNotFiniteAndInvalidNames) {
    for (const TransformStamped& bad :
         {place("map", "base_link", {nan, 0, 0}),
          place("map", "base_link", {0, std::numeric_limits<double>::infinity(), 0}),
          place("map", "base_link", {}, {0, 0, 0, 0}), place("map", "base_link", {}, {nan, 0, 0, 1})})
        EXPECT_THAT(moving(bad, 100), HasSubstr("base_link: translation and rotation are not finite"));
    EXPECT_THAT(moving(place("", "base_link", {}), 100), HasSubstr("without the name"));
    EXPECT_THAT(moving(place("map", "/", {}), 100), HasSubstr("without the name"));
    EXPECT_THAT(moving(place("map", std::string(1000, 'x'), {}), 100), HasSubstr("255 characters"));
    EXPECT_FALSE(find().placed);
}

TEST_F(TransformTreeTest, NormalisesRotations) {
    moving(place("map", "base_link", {}, {0, 0, 5, 5}), 100);
    EXPECT_DOUBLE_EQ(glm::length(find().placed->orientation), 1);
    EXPECT_LT(glm::distance(find().placed->orientation * glm::dvec3(1, 0, 0), {0, 1, 0}), 1e-12);
}

TEST_F(TransformTreeTest, KeepsTheFirstOfTwoParentsUntilItIsSilent) {
    moving(place("map", "base_link", {1, 0, 0}), 100);
    EXPECT_EQ(moving(place("odom", "base_link", {2, 0, 0}), 100.5), "base_link has two parents, map and odom");
    expectAt(100.5, 100, {1, 0, 0});
    const uint64_t before = tree.lives();
    EXPECT_EQ(moving(place("odom", "base_link", {2, 0, 0}), 101.5), "");
    EXPECT_GT(tree.lives(), before);
    EXPECT_THAT(find().diagnostic, HasSubstr("only to odom"));
}

TEST_F(TransformTreeTest, RefusesToMoveStaticFramesAndTheReverse) {
    fixed(place("map", "base_link", {1, 0, 0}));
    EXPECT_EQ(moving(place("map", "base_link", {2, 0, 0}), 200), "base_link is published on /tf and on /tf_static");
    moving(place("map", "other", {1, 0, 0}), 100);
    EXPECT_EQ(fixed(place("map", "other", {2, 0, 0})), "other is published on /tf and on /tf_static");
}

TEST_F(TransformTreeTest, RefusesStampsThatGoBackUntilTheirSenderHasBeenSilent) {
    moving(place("map", "base_link", {1, 0, 0}), 100);
    EXPECT_THAT(tree.add(place("map", "base_link", {9, 0, 0}), false, at(99), at(100.1)),
                HasSubstr("before the previous stamp"));
    EXPECT_EQ(tree.add(place("map", "base_link", {9, 0, 0}), false, at(100), at(100.1)), "") << "sent twice";
    expectAt(100, 100, {1, 0, 0});
    EXPECT_EQ(tree.add(place("map", "base_link", {2, 0, 0}), false, at(50), at(102)), "") << "a bag that is looped";
    expectAt(102, 50, {2, 0, 0});
}

TEST_F(TransformTreeTest, RefusesAStampFarAheadButNotALittleAhead) {
    EXPECT_THAT(tree.add(place("map", "odom", {}), false, at(111), at(100)), HasSubstr("ahead of the clock"));
    moving(place("map", "odom", {1, 0, 0}), 100);
    EXPECT_EQ(tree.add(place("map", "odom", {1, 0, 0}), false, at(101), at(100)), "");
    moving(place("odom", "base_link", {1, 0, 0}), 100.5);
    expectAt(100.5, 100.5, {2, 0, 0});
}

TEST_F(TransformTreeTest, NeitherFramesNorTransformsFillTheMemory) {
    std::string last;
    for (int i = 0; i < 2000; ++i) last = moving(place("map", "frame_" + std::to_string(i), {}), 100);
    EXPECT_EQ(last, "more frames than are kept");
    moving(place("map", "frame_0", {}), 100);
    for (int i = 0; i < 5000; ++i) moving(place("map", "frame_0", {double(i), 0, 0}), 100.1 + 1e-3 * i);
    const auto [placed, diagnostic] = tree.newest("map", "frame_0", at(106));
    ASSERT_TRUE(placed) << diagnostic;
    EXPECT_EQ(placed->position.x, 4999);
}

}  // namespace
}  // namespace insonify::ros
