// Lines from the sonar compared with every triangle of a scene, and sonars inside of meshes.
#include <gmock/gmock.h>

#include "components/sonar/surfaces/Sightlines.hpp"
#include "tests/sonar/ClusteredHarbour.hpp"
#include "tests/support/Surfaces.hpp"

namespace insonify::sonar {
namespace {

/** Returns whether the line between two points passes through any triangle, by testing each: both ends are on different
 *  sides of its plane, and the line is on the same side of its three edges. */
bool isCrossed(const types::Geometry& geometry, const std::vector<glm::dmat4>& places, const glm::dvec3& from,
               const glm::dvec3& to) {
    const auto volume = [](glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) { return glm::dot(glm::cross(a, b), c); };
    for (size_t object = 0; object < places.size(); ++object) {
        const types::Mesh& mesh = geometry.meshes[static_cast<size_t>(geometry.objects[object].mesh)];
        const auto corner = [&](size_t i) {
            return glm::dvec3(places[object] * glm::dvec4(mesh.positions[mesh.indices[i]], 1));
        };
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const glm::dvec3 a = corner(i), b = corner(i + 1), c = corner(i + 2), way = to - from;
            const double first = volume(b - a, c - a, from - a), second = volume(b - a, c - a, to - a);
            if (first * second >= 0) continue;
            const double ab = volume(a - from, b - from, way), bc = volume(b - from, c - from, way),
                         ca = volume(c - from, a - from, way);
            if ((ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0)) return true;
        }
    }
    return false;
}

std::vector<glm::dmat4> getPlaces(const types::Snapshot& snapshot) {
    std::vector<glm::dmat4> places;
    for (const types::Object& object : snapshot.geometry->objects) places.push_back(object.world_from_object);
    for (const types::MovedObject& moved : snapshot.moved) places[moved.object] = moved.world_from_object;
    return places;
}

TEST(SightlinesTest, APointIsVisibleIfNoTriangleIsBeforeIt) {
    Random random(7);
    for (const types::GeometryPtr& geometry :
         {types::GeometryPtr(clusteredHarbour()), types::GeometryPtr(test::surfaces())}) {
        Sightlines lines(*geometry), by_trees(*geometry, Sightlines::Lines::Many);
        types::Snapshot snapshot = test::makeSnapshot(geometry);
        int open = 0;
        for (int ping = 0; ping < 20; ++ping) {
            snapshot.sonar.position = uniformVector(random, 3);
            snapshot.moved.clear();
            if (ping % 2 == 1)
                snapshot.moved = {{1, glm::rotate(glm::translate(glm::dmat4(1), uniformVector(random, 6)), 0.4,
                                                  glm::dvec3(1, 2, 3))}};
            lines.place(snapshot);
            by_trees.place(snapshot);
            const auto places = getPlaces(snapshot);
            for (int i = 0; i < 25; ++i) {
                const glm::dvec3 point = snapshot.sonar.position + uniformVector(random, 14);
                const bool crossed = isCrossed(*geometry, places, snapshot.sonar.position, point);
                EXPECT_EQ(lines.isOpen(point), !crossed) << ping << " " << i;
                EXPECT_EQ(by_trees.isOpen(point), !crossed) << ping << " " << i;
                open += crossed ? 0 : 1;
            }
        }
        EXPECT_GT(open, 50);
        EXPECT_LT(open, 450);
    }
}

TEST(SightlinesTest, AnObjectFlattenedByItsScaleHidesByTreesToo) {
    auto geometry = std::make_shared<types::Geometry>(*test::makeScene({test::sphere(1, 20)}));
    geometry->objects[0].world_from_object = glm::scale(glm::dmat4(1), {0.0, 1.0, 1.0});
    Sightlines lines(*geometry, Sightlines::Lines::Many);
    lines.place(test::makeSnapshot(geometry, {-5, 0.1, 0.2}));
    EXPECT_FALSE(lines.isOpen({5, 0.1, 0.2}));
    EXPECT_TRUE(lines.isOpen({5, 2.5, 0.2}));
}

TEST(SightlinesTest, TrianglesWithinAMillimetreOfEitherEndHideNothing) {
    const auto geometry = test::makeScene({test::wall(5)});
    Sightlines lines(*geometry);
    lines.place(test::makeSnapshot(geometry, {4.9995, 0, 0}));
    EXPECT_TRUE(lines.isOpen({9, 0, 0}));
    lines.place(test::makeSnapshot(geometry));
    EXPECT_TRUE(lines.isOpen({5, 1, 1}));
    EXPECT_TRUE(lines.isOpen({5.0009, 0, 0}));
    EXPECT_FALSE(lines.isOpen({5.002, 0, 0}));
}

TEST(SightlinesTest, ASonarIsInsideAMeshThatShowsOnlyBacks) {
    const auto findInside = [](const types::GeometryPtr& geometry, const glm::dvec3& place) {
        Sightlines lines(*geometry);
        lines.place(test::makeSnapshot(geometry, place));
        return lines.enclosing();
    };
    types::Mesh pool = test::sphere(2, 20);  // with inward faces, as in a tank
    for (size_t i = 0; i < pool.indices.size(); i += 3) std::swap(pool.indices[i], pool.indices[i + 1]);
    const auto scene =
        test::makeScene({test::ground(-4, 200), test::sphere(2, 20), pool}, 0, {{0, 0, 0}, {10, 0, 0}, {-10, 0, 0}});
    EXPECT_EQ(findInside(scene, {10, 0.3, 0.2}), std::optional<uint32_t>(1));
    EXPECT_EQ(findInside(scene, {11.9, 0, 0}), std::optional<uint32_t>(1));
    EXPECT_FALSE(findInside(scene, {12.1, 0, 0}));
    EXPECT_FALSE(findInside(scene, {-10, 0, 0})) << "a tank";
    EXPECT_FALSE(findInside(scene, {0, 0, 0}));
    EXPECT_FALSE(findInside(scene, {0, 0, -5})) << "below a sheet";
    const auto harbour = clusteredHarbour();
    EXPECT_EQ(findInside(harbour, {9, 4, -3.2}), std::optional<uint32_t>(1));
    EXPECT_EQ(findInside(harbour, {-12, 6, -2}), std::optional<uint32_t>(2)) << "mirrored";
    EXPECT_FALSE(findInside(harbour, {0, 0, 0}));
}

}  // namespace
}  // namespace insonify::sonar
