// Meshes whose vertices are far from their origin lose the shape of small facets.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "components/scene/Scene.hpp"
#include "tests/support/Scenes.hpp"

namespace insonify::scene {
namespace {

/** An upright pipe of facets of a width [m], at a distance from its mesh's origin [m]. */
types::Mesh pipeAt(double distance, double facet) {
    constexpr double radius = 0.15;
    const auto around = static_cast<uint32_t>(2 * std::numbers::pi * radius / facet);
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < around; ++i) {
        const double angle = 2 * std::numbers::pi * i / around;
        for (const double z : {-0.2, 0.2})
            positions.emplace_back(distance + radius * std::cos(angle), radius * std::sin(angle), z);
        const uint32_t a = 2 * i, b = 2 * ((i + 1) % around);
        indices.insert(indices.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
    return test::getMesh(positions, indices);
}

TEST(VertexRoundingTest, StepsAreThoseOfFloatsAndTurnNormalsByTheirShareOfAFacet) {
    for (const double distance : {700.0, 1000.0, 3000.0, 1e5}) {
        const auto rounding = findRounding(pipeAt(distance, 0.002));
        ASSERT_TRUE(rounding) << distance;
        EXPECT_NEAR(rounding->farthest, distance + 0.15, 0.01);
        EXPECT_EQ(rounding->step, std::exp2(std::floor(std::log2(distance)) - 23));
        EXPECT_GT(rounding->share, 0.9);
        if (distance < 2000) {
            EXPECT_NEAR(rounding->tilt, rounding->step / 0.002, 0.2 * rounding->tilt) << distance;
        }
    }
}

TEST(VertexRoundingTest, NothingIsSaidOfMeshesThatAreGoodOrThatWouldNotGain) {
    EXPECT_FALSE(findRounding(pipeAt(0, 0.002)));
    EXPECT_FALSE(findRounding(pipeAt(100, 0.002)));
    EXPECT_FALSE(findRounding(pipeAt(1000, 0.05)));
    EXPECT_FALSE(findRounding(test::ground(-1000)));
    EXPECT_FALSE(findRounding(test::wall(20000)));
    EXPECT_FALSE(findRounding({}));
}

TEST(VertexRoundingTest, ANoticeNamesTheObjectsAndTheirPoseDoesNotMatter) {
    auto geometry = test::makeScene({pipeAt(1000, 0.002), pipeAt(0, 0.002)}, 0, {{0, 0, 0}, {1e5, 0, 0}});
    noteRounding(geometry);
    ASSERT_EQ(geometry->notices.size(), 1u);
    EXPECT_THAT(geometry->notices[0],
                testing::AllOf(testing::HasSubstr("object_0, up to 1000 m away in steps of 0.061 mm"),
                               testing::Not(testing::HasSubstr("object_1"))));
    types::GeometryPtr good = test::makeScene({pipeAt(0, 0.002)}, 0, {{1e6, 0, 0}});
    const types::GeometryPtr before = good;
    noteRounding(good);
    EXPECT_EQ(good, before) << "no copy";
}

}  // namespace
}  // namespace insonify::scene
