// Paths to point targets by mirrors, compared with a search through all sequences of mirror triangles
// (ACOUSTICS.md 5.23).
#include <gmock/gmock.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "tests/sonar/TriedPaths.hpp"
#include "tests/support/Allocations.hpp"
#include "tests/support/Scenes.hpp"

namespace insonify::sonar {
namespace {

constexpr double range_max = 30;  // m

using Generator = std::mt19937_64;

double evenly(Generator& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

glm::dvec3 uniformVector(Generator& random, double size) {
    return {evenly(random, -size, size), evenly(random, -size, size), evenly(random, -size, size)};
}

glm::dmat4 uniformPlace(Generator& random, double size) {
    const glm::dmat4 shift = glm::translate(glm::dmat4(1), uniformVector(random, size));
    return glm::rotate(shift, evenly(random, 0, 3), glm::normalize(uniformVector(random, 1)));
}

/** A parallelogram of n x n cells, whose corners are moved off its plane by up to `rough` [m]. */
types::Mesh cells(const glm::dvec3& corner, const glm::dvec3& a, const glm::dvec3& b, uint32_t n, Generator& random,
                  double rough = 0) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    const glm::dvec3 normal = glm::normalize(glm::cross(a, b));
    for (uint32_t i = 0; i <= n; ++i)
        for (uint32_t j = 0; j <= n; ++j)
            positions.push_back(corner + a * (1.0 * i / n) + b * (1.0 * j / n) +
                                normal * evenly(random, -rough, rough));
    for (uint32_t i = 0; i < n; ++i)
        for (uint32_t j = 0; j < n; ++j) {
            const uint32_t k = i * (n + 1) + j;
            indices.insert(indices.end(), {k, k + n + 1, k + 1, k + 1, k + n + 1, k + n + 2});
        }
    return test::getMesh(positions, indices);
}

types::Mesh joined(const std::vector<types::Mesh>& meshes) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    for (const types::Mesh& mesh : meshes) {
        const auto before = static_cast<uint32_t>(positions.size());
        positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
        for (const uint32_t index : mesh.indices) indices.push_back(before + index);
    }
    return test::getMesh(positions, indices);
}

/** Four walls and a bottom about the origin. */
types::Mesh tank(uint32_t n, Generator& random, double rough = 0) {
    const double x = 12, y = 9, z = 3;
    const glm::dvec3 corner(-x, -y, -z), ahead(2 * x, 0, 0), aside(0, 2 * y, 0), up(0, 0, 2 * z);
    return joined({cells(corner, ahead, up, n, random, rough), cells(corner + aside, ahead, up, n, random, rough),
                   cells(corner, aside, up, n, random, rough), cells(corner + ahead, aside, up, n, random, rough),
                   cells(corner, ahead, aside, n, random, rough)});
}

/** Triangles at random places, some without area. */
types::Mesh strewn(Generator& random, int count, double size) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    for (int i = 0; i < count; ++i) {
        for (uint32_t k = 0; k < 3; ++k) {
            indices.push_back(static_cast<uint32_t>(positions.size()));
            positions.push_back(uniformVector(random, size));
        }
        const glm::vec3 end = positions.back();
        positions.push_back(end + glm::vec3(1, 0, 0));
        const auto last = static_cast<uint32_t>(positions.size()) - 1;
        indices.insert(indices.end(), {last, last - 1, last});
    }
    return test::getMesh(positions, indices);
}

/** Objects with one mirror material each. With `obstacle` the last is no mirror. */
types::GeometryPtr mirrors(std::vector<types::Mesh> meshes, std::vector<glm::dmat4> places = {},
                           bool obstacle = false) {
    auto geometry = std::make_shared<types::Geometry>();
    places.resize(meshes.size(), glm::dmat4(1));
    for (size_t i = 0; i < meshes.size(); ++i) {
        types::Material material;
        material.mirror = !obstacle || i + 1 < meshes.size();
        material.reflection = 0.9f - 0.1f * static_cast<float>(i);
        geometry->materials.push_back(material);
        meshes[i].clusters[0].material = static_cast<int>(i);
        geometry->objects.push_back({"object_" + std::to_string(i), static_cast<int>(i), places[i]});
    }
    geometry->meshes = std::move(meshes);
    return geometry;
}

SonarConfig bouncingSonar(bool surface = false, int bounces = 2) {
    SonarConfig config;
    config.multipath.emplace().bounces = bounces;
    if (surface) config.multipath->surface.emplace();
    return config;
}

struct Case {
    const char* name;
    types::GeometryPtr geometry;
    double size;       ///< Half the box of sonars and targets about the origin [m].
    double tolerance;  ///< Max difference; 0: the same bit for bit [m].
    bool surface = false;
    bool moving = false;  ///< The second object has a new place in most pings.
};

void expectSame(const TargetPath& path, const TargetPath& tried, double tolerance) {
    EXPECT_EQ(path.reflections, tried.reflections);
    EXPECT_EQ(path.by_surface, tried.by_surface);
    EXPECT_NEAR(path.length, tried.length, tolerance);
    EXPECT_LE(glm::distance(path.direction, tried.direction), tolerance);
    EXPECT_NEAR(path.power, tried.power, tolerance);
    EXPECT_NEAR(path.sine_grazing, tried.sine_grazing, tolerance);
}

/** Returns the number of paths by two mirrors. */
size_t expectAsTried(const Case& one, Generator& random) {
    TargetPaths paths(bouncingSonar(one.surface), *one.geometry);
    size_t twice = 0;
    for (int ping = 0; ping < 6; ++ping) {
        types::Snapshot snapshot = test::makeSnapshot(one.geometry, uniformVector(random, one.size), 0.7 * ping, 0.2);
        if (one.surface) snapshot.water_surface = one.size + 0.3;
        if (one.moving && ping % 3 > 0) snapshot.moved = {{1, uniformPlace(random, one.size)}};
        paths.place(snapshot, range_max);
        TriedPaths all(snapshot, one.surface, 2 * range_max);
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 point = uniformVector(random, one.size);
            const std::vector<TargetPath>& found = paths.pathsTo(point);
            const std::vector<TargetPath> tried = all.to(point);
            EXPECT_EQ(found.size(), tried.size()) << one.name << ", ping " << ping << ", target " << i;
            if (found.size() != tried.size()) return 0;
            for (size_t k = 0; k < found.size(); ++k) {
                expectSame(found[k], tried[k], one.tolerance);
                twice += found[k].reflections == 2;
            }
        }
    }
    return twice;
}

TEST(TargetPathsTest, MatchAllSequencesOfTriangles) {
    Generator random(11);
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1), 0.3, glm::dvec3(1, 2, 3));
    const Case cases[] = {
        {"strewn", mirrors({strewn(random, 40, 8)}), 6, 0},
        {"strewn below the surface", mirrors({strewn(random, 40, 8)}), 6, 0, true},
        {"tank of rough walls", mirrors({tank(3, random, 0.2)}), 2.6, 0, true},
        {"tank", mirrors({tank(4, random)}), 2.9, 1e-12},
        {"box and surface", mirrors({tank(1, random)}), 2.9, 1e-12, true},
        {"in a ball", mirrors({test::sphere(5, 6)}), 2.7, 1e-5},
        {"ball in a tank", mirrors({tank(1, random), test::sphere(1, 5)}), 2.9, 1e-5, false, true},
        {"mirrored and stretched", mirrors({tank(2, random)}, {glm::scale(turned, {1.0, -1.1, 1.5})}), 2.5, 1e-12},
        {"plates that move before an obstacle",
         mirrors({tank(1, random), strewn(random, 6, 3), test::sphere(0.8, 6)}, {}, true), 2.9, 1e-12, true, true},
        {"no mirror", mirrors({test::sphere(1, 6)}, {}, true), 3, 0},
    };
    for (const Case& one : cases) {
        const size_t twice = expectAsTried(one, random);
        EXPECT_EQ(twice > 0, one.name != std::string("no mirror")) << one.name;
    }
}

/** A wall across the x axis 4 m ahead, of two triangles whose common edge meets the axis. */
types::Mesh halvedWall(bool other_winding = false) {
    types::Mesh mesh = test::quad({4, -3, -3}, {0, 6, 0}, {0, 0, 6});
    if (other_winding) std::swap(mesh.indices[3], mesh.indices[4]);
    return mesh;
}

/** The same wall, with a corner of the triangles of its upper half on an edge of the lower. */
types::Mesh wallWithTJunction() {
    return test::getMesh({{4, -3, -3}, {4, 3, -3}, {4, 3, 0}, {4, -3, 0}, {4, 0, 0}, {4, 3, 3}, {4, -3, 3}},
                         {0, 1, 2, 0, 2, 3, 3, 4, 6, 4, 5, 6, 4, 2, 5});
}

struct Wall {
    const char* name;
    std::vector<types::Mesh> meshes;  ///< One per object.
};

TEST(TargetPathsTest, AMirrorPointOnACommonEdgeIsOnePath) {
    Generator random(3);
    types::Mesh half = halvedWall(), other_half = half;
    half.indices.resize(3);
    other_half.indices.erase(other_half.indices.begin(), other_half.indices.begin() + 3);
    half.clusters[0].index_count = other_half.clusters[0].index_count = 3;
    const Wall walls[] = {{"two triangles", {halvedWall()}},
                          {"of other windings", {halvedWall(true)}},
                          {"of two objects", {half, other_half}},
                          {"twice in the same place", {halvedWall(), halvedWall()}},
                          {"at a corner on an edge", {wallWithTJunction()}}};
    for (const Wall& wall : walls)
        for (int turn = 0; turn < 100; ++turn) {
            const glm::dmat4 place = turn == 0 ? glm::dmat4(1) : uniformPlace(random, 20);
            const auto inWorld = [&](const glm::dvec3& point) { return glm::dvec3(place * glm::dvec4(point, 1)); };
            const auto geometry = mirrors(wall.meshes, std::vector(wall.meshes.size(), place));
            TargetPaths paths(bouncingSonar(), *geometry);
            paths.place(test::makeSnapshot(geometry, inWorld({0, 1, 0.5})), range_max);
            const std::vector<TargetPath>& found = paths.pathsTo(inWorld({0, -1, -0.5}));
            ASSERT_EQ(found.size(), 2u) << wall.name << ", turn " << turn;
            EXPECT_EQ(found[1].reflections, 1);
            EXPECT_NEAR(found[1].length, 2 * std::sqrt(16 + 1 + 0.25), 1e-9);
        }
}

TEST(TargetPathsTest, TheIntersectionOfTwoMirrorsIsOnePathByBoth) {
    Generator random(5);
    const types::Mesh corner =
        joined({test::quad({4, -4, -4}, {0, 8, 0}, {0, 0, 8}), test::quad({-4, 4, -4}, {8, 0, 0}, {0, 0, 8})});
    for (int turn = 0; turn < 100; ++turn) {
        const glm::dmat4 place = turn == 0 ? glm::dmat4(1) : uniformPlace(random, 20);
        const auto inWorld = [&](const glm::dvec3& point) { return glm::dvec3(place * glm::dvec4(point, 1)); };
        const auto geometry = mirrors({corner}, {place});
        TargetPaths paths(bouncingSonar(), *geometry);
        paths.place(test::makeSnapshot(geometry, inWorld({0, 0, 1})), range_max);
        const std::vector<TargetPath>& found = paths.pathsTo(inWorld({2, 2, -1}));
        ASSERT_EQ(found.size(), 4u) << turn;
        const auto by_both = std::ranges::find(found, 2, &TargetPath::reflections);
        ASSERT_NE(by_both, found.end());
        EXPECT_NEAR(by_both->length, std::sqrt(6 * 6 + 6 * 6 + 2 * 2), 1e-9);
    }
}

TEST(TargetPathsTest, ATargetOnAMirrorHasNoPathByIt) {
    Generator random(6);
    for (int turn = 0; turn < 100; ++turn) {
        const glm::dmat4 place = uniformPlace(random, 20);
        const auto inWorld = [&](const glm::dvec3& point) { return glm::dvec3(place * glm::dvec4(point, 1)); };
        const auto geometry = mirrors({halvedWall()}, {place});
        TargetPaths paths(bouncingSonar(), *geometry);
        paths.place(test::makeSnapshot(geometry, inWorld({0, 0, 0})), range_max);
        EXPECT_EQ(paths.pathsTo(inWorld({4, 1, 0.3})).size(), 1u) << turn;
    }
}

TEST(TargetPathsTest, AreInTheOrderOfTheirMirrorsInTheScene) {
    Generator random(7);
    const auto geometry = mirrors({tank(3, random)});
    TargetPaths paths(bouncingSonar(true), *geometry);
    types::Snapshot snapshot = test::makeSnapshot(geometry, {-3, 1, 0.5});
    snapshot.water_surface = 2.5;
    paths.place(snapshot, range_max);
    const std::vector<TargetPath>& found = paths.pathsTo({4, -2, -1});
    EXPECT_TRUE(std::ranges::is_sorted(found, {}, &TargetPath::mirrors));
    EXPECT_EQ(found[0].reflections, 0);
    EXPECT_THAT(found[1].mirrors, testing::ElementsAre(1u, 0u)) << "the surface before all triangles";
    EXPECT_EQ(found.size(), 1u + 6 + 18) << "two walls in one of both orders, or in both where they are opposite";
}

TEST(TargetPathsTest, AllocateNothingAfterTheFirstPing) {
    Generator random(8);
    for (const auto& geometry : {mirrors({tank(6, random)}), mirrors({tank(1, random), test::sphere(1, 8)})}) {
        TargetPaths paths(bouncingSonar(true), *geometry);
        types::Snapshot snapshot = test::makeSnapshot(geometry, {0, 0, 20});
        snapshot.water_surface = 2.8;
        snapshot.moved.reserve(1);
        for (int ping = 0; ping < 30; ++ping) {
            test::takeCounted();
            test::countHere(true);
            paths.place(snapshot, range_max);
            for (int i = 0; i < 10; ++i) paths.pathsTo(uniformVector(random, 2.7));
            test::countHere(false);
            EXPECT_TRUE(test::takeCounted().empty() || ping == 0) << ping;
            snapshot.sonar.position = uniformVector(random, 2.7);
            if (geometry->objects.size() > 1) snapshot.moved = {{1, uniformPlace(random, 2)}};
        }
    }
}

}  // namespace
}  // namespace insonify::sonar
