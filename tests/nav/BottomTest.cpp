// Ranges of straight beams, compared with closed forms.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "components/nav/Dvl.hpp"
#include "tests/support/Deformed.hpp"
#include "tests/support/Surfaces.hpp"
#include "types/geometry/Extent.hpp"

namespace insonify::nav {
namespace {

Bottom makeBottom(types::Snapshot snapshot) {
    Bottom bottom;
    bottom.take(std::make_shared<types::Snapshot>(std::move(snapshot)));
    return bottom;
}

const glm::dvec3 down(0, 0, -1);

TEST(BottomTest, ALevelBottomIsHitFromAboveAndFromBelow) {
    const Bottom bottom(-20.0);
    EXPECT_EQ(bottom.range({5, 6, -8}, down, 100), 12);
    EXPECT_EQ(bottom.range({5, 6, -26}, -down, 100), 6);
    EXPECT_EQ(bottom.range({5, 6, -8}, -down, 100), std::nullopt);
    EXPECT_EQ(bottom.range({5, 6, -8}, {1, 0, 0}, 1e300), std::nullopt);
    EXPECT_EQ(bottom.range({5, 6, -8}, down, 11.9), std::nullopt) << "too far";
    EXPECT_EQ(Bottom().range({5, 6, -8}, down, 100), std::nullopt);
}

TEST(BottomTest, AFloorOfTrianglesIsWhereALevelBottomIs) {
    const Bottom floor = makeBottom(test::makeSnapshot(test::makeScene({test::ground(-20)})));
    const Bottom level(-20.0);
    for (const glm::dvec3 way : {glm::dvec3(0.3, 0.4, -0.8), glm::dvec3(-0.1, 0.7, -0.2), down}) {
        const glm::dvec3 direction = glm::normalize(way);
        const auto range = floor.range({5, 6, -8}, direction, 200);
        ASSERT_TRUE(range);
        EXPECT_NEAR(*range, *level.range({5, 6, -8}, direction, 200), 1e-9);
    }
    EXPECT_FALSE(floor.range({5, 6, -8}, -down, 200));
    EXPECT_FALSE(floor.range({5, 6, -8}, down, 11.9));
}

TEST(BottomTest, FindsTheNearestOfManyMovedObjects) {
    auto geometry = test::surfaces();  // ground at -4, and a block, turned, among others
    types::Snapshot snapshot = test::makeSnapshot(geometry);
    EXPECT_NEAR(*makeBottom(snapshot).range({-30, 30, 0}, down, 100), 4, 1e-6);
    const auto ball = static_cast<uint32_t>(1);  // 1.5 m, of flat triangles
    snapshot.moved = {{ball, glm::translate(glm::dmat4(1), {-30, 30, -2})}};
    Bottom bottom = makeBottom(snapshot);
    EXPECT_NEAR(*bottom.range({-30, 30, 10}, down, 100), 10.5, 0.02);
    EXPECT_NEAR(*bottom.range({-30, 33, 0}, down, 100), 4, 1e-6) << "next to the ball";
    EXPECT_NEAR(*bottom.range({9, 3, 10}, down, 100), 14, 1e-6) << "nor is it where it was";
    snapshot.moved.clear();
    bottom.take(std::make_shared<types::Snapshot>(snapshot));
    EXPECT_NEAR(*bottom.range({9, 3, 10}, down, 100), 9.5, 0.02) << "back at its place in the file";
    EXPECT_NEAR(*bottom.range({-10, 12, 10}, down, 100), 8.5, 0.02) << "one that is mirrored and stretched";
}

TEST(BottomTest, AMeshThatDeformsIsWhereItIsPosed) {
    auto geometry = std::make_shared<types::Geometry>(*test::surfaces());
    const uint32_t ball = 1;  // shares its mesh with another object
    geometry->meshes[1] = test::jointed(geometry->meshes[1]);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> number(-1, 1);
    const auto vector = [&] { return glm::dvec3(number(random), number(random), number(random)); };
    Bottom bottom;
    int hits = 0;
    for (int trial = 0; trial < 50; ++trial) {
        types::Snapshot snapshot = test::makeSnapshot(geometry);
        const glm::dmat4 joint =
            glm::rotate(glm::translate(glm::dmat4(1), 5.0 * vector()), 3 * number(random), vector());
        if (trial % 5 > 0) test::pose(snapshot, ball, glm::scale(joint, glm::dvec3(1.2, 0.5, 2)));
        if (trial % 3 > 0) snapshot.moved = {{ball, glm::translate(glm::dmat4(1), 10.0 * vector())}};
        const Bottom by_hand = makeBottom(test::rigid(snapshot));
        bottom.take(std::make_shared<types::Snapshot>(snapshot));
        const types::Extent extent = types::getExtent(
            test::rigid(snapshot)
                .geometry->meshes[static_cast<size_t>(test::rigid(snapshot).geometry->objects[1].mesh)],
            snapshot.moved.empty() ? geometry->objects[ball].world_from_object : snapshot.moved[0].world_from_object);
        const glm::dvec3 from = 15.0 * vector(), middle = (extent.low + extent.high) / 2.0;
        for (int beam = 0; beam < 10; ++beam) {
            const glm::dvec3 direction = glm::normalize(middle + vector() - from);
            const auto range = bottom.range(from, direction, 100);
            EXPECT_EQ(range, by_hand.range(from, direction, 100)) << trial;
            hits += range && *range < glm::distance(middle, from) + 2;
        }
    }
    EXPECT_GT(hits, 100);
}

TEST(BottomTest, APlateOnAJointIsAsHighAsItsJoint) {
    const auto geometry = test::makeScene({test::jointed(test::ground(-20))});
    Bottom bottom;
    for (const double up : {0.0, 3.0, -70.0, 12.0}) {
        types::Snapshot snapshot = test::makeSnapshot(geometry);
        test::pose(snapshot, 0, glm::translate(glm::dmat4(1), {0, 0, up}));
        bottom.take(std::make_shared<types::Snapshot>(snapshot));
        EXPECT_NEAR(*bottom.range({0, 0, -5}, down, 100), 15 - up, 1e-5);
    }
    bottom.take(std::make_shared<types::Snapshot>(test::makeSnapshot(geometry)));
    EXPECT_NEAR(*bottom.range({0, 0, -5}, down, 100), 15, 1e-5) << "at rest again";
}

TEST(BottomTest, ANewGeometryReplacesTheFirst) {
    Bottom bottom = makeBottom(test::makeSnapshot(test::makeScene({test::ground(-20)})));
    bottom.take(std::make_shared<types::Snapshot>(test::makeSnapshot(test::makeScene({test::ground(-10)}))));
    EXPECT_NEAR(*bottom.range({0, 0, -8}, down, 100), 2, 1e-9);
    bottom.take(std::make_shared<types::Snapshot>());
    EXPECT_FALSE(bottom.range({0, 0, -8}, down, 100)) << "one without a geometry";
    bottom.take(std::make_shared<types::Snapshot>(test::makeSnapshot(std::make_shared<types::Geometry>())));
    EXPECT_FALSE(bottom.range({0, 0, -8}, down, 100)) << "one without objects";
}

TEST(BottomTest, UnderWaterIsBelowTheSurfaceOfTheScene) {
    types::Snapshot snapshot = test::makeSnapshot(test::makeScene({test::ground(-20)}));
    EXPECT_TRUE(makeBottom(snapshot).isUnderWater({0, 0, 5})) << "without a surface all is water";
    snapshot.water_surface = 1;
    EXPECT_TRUE(makeBottom(snapshot).isUnderWater({0, 0, 0.5}));
    EXPECT_FALSE(makeBottom(snapshot).isUnderWater({0, 0, 1.5}));
    EXPECT_TRUE(Bottom(-20.0).isUnderWater({0, 0, 5}));
}

}  // namespace
}  // namespace insonify::nav
