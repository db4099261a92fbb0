// Maps whose normals all lean by one angle, on a wall at normal incidence: its echo is proportional to the cosine, its
// range does not change (ACOUSTICS.md 3.4).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "tests/support/Sonars.hpp"
#include "tests/support/Surfaces.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

/** A wall 20 m ahead whose normals lean to port. */
types::GeometryPtr wallWithNormalsAt(double lean) {
    auto geometry = std::make_shared<types::Geometry>(*test::makeScene({test::mappedWall()}));
    geometry->objects[0].world_from_object = glm::scale(glm::translate(glm::dmat4(1), {20, 0, 0}), glm::dvec3(1, 5, 5));
    const auto channel = [](double x) { return static_cast<uint8_t>(std::lround((x + 1) / 2 * 255)); };
    geometry->normal_maps = {{1, 1, {channel(std::sin(lean)), channel(0), channel(std::cos(lean))}, true, true}};
    geometry->materials[0].normal_map = 0;
    return geometry;
}

std::vector<float> getEcho(const types::GeometryPtr& geometry) {
    SonarConfig config = test::getSonar({.width_deg = 2, .height_deg = 2, .bins = 250});
    config.device = "software";
    return test::makePing(config, test::makeSnapshot(geometry)).bins;
}

/** A wall 20 m ahead with a fine bumpy map, stretched by its vertices or by its object. */
types::GeometryPtr bumpyWall(const glm::dvec3& size, bool by_object) {
    types::Mesh mesh = test::mappedWall();
    if (!by_object)
        for (glm::vec3& position : mesh.positions) position *= glm::vec3(size);
    auto geometry = std::make_shared<types::Geometry>(*test::makeScene({mesh}));
    const glm::dmat4 place = glm::translate(glm::dmat4(1), {20.03, 0, 0});  // within a bin
    geometry->objects[0].world_from_object = by_object ? glm::scale(place, size) : place;
    geometry->normal_maps = {test::bumpyMap(256)};
    geometry->materials[0].normal_map = 0;
    return geometry;
}

/** Relief that is much finer than the samples of a beam on a wall: normals lean by angles [rad], in one direction of
 * the map, counted from its columns' to its rows'. */
struct FineRelief {
    static constexpr int size = 512;
    std::vector<glm::dvec3> normals;  ///< As the map's bytes have them.
    types::NormalMap map{size, size, {}, true, true};

    FineRelief(double direction, const std::function<double()>& lean) {
        for (int i = 0; i < size * size; ++i) {
            const double angle = lean();
            for (const double axis :
                 {std::sin(angle) * std::cos(direction), std::sin(angle) * std::sin(direction), std::cos(angle)}) {
                const auto byte = static_cast<uint8_t>(std::lround((axis + 1) / 2 * 255));
                map.rgb.push_back(byte);
            }
            const uint8_t* bytes = &map.rgb[map.rgb.size() - 3];
            normals.push_back(glm::normalize(glm::dvec3(bytes[0], bytes[1], bytes[2]) / 127.5 - 1.0));
        }
    }
    /** Returns the mean of the cosines of incidence, of which those of normals that face away are 0. `ahead`: what the
     *  map's columns and rows are along the direction to the sonar, projected on the wall. */
    double computeMeanFacing(double incidence, const glm::dvec2& ahead) const {
        double sum = 0;
        for (const glm::dvec3& n : normals)
            sum += std::max(std::cos(incidence) * n.z + std::sin(incidence) * glm::dot(ahead, glm::dvec2(n)), 0.0);
        return sum / static_cast<double>(normals.size());
    }
};

/** How a map lies on a wall: its columns' direction from port [rad], and whether its rows are to the left of it. */
struct Laid {
    double turned;
    bool is_left;
};

/** Returns the echo of a wall 20 m ahead, turned by an angle, over that of the wall without relief; and the same by the
 *  means of its normals. */
std::pair<double, double> compareRelief(const FineRelief& relief, double turned, const Laid& laid) {
    SonarConfig config = test::getSonar({.width_deg = 2, .height_deg = 1, .bins = 300, .rows = 8, .columns = 1});
    config.visibility = Visibility::Cpu;
    const auto ping = [&](const types::NormalMap& map) {
        types::Mesh wall = test::mappedWall();
        const glm::vec2 columns(std::cos(laid.turned), std::sin(laid.turned));
        wall.tangents.assign(4, {0, columns, laid.is_left ? 1 : -1});
        auto geometry = std::make_shared<types::Geometry>(*test::makeScene({wall}));
        geometry->objects[0].world_from_object = glm::scale(
            glm::rotate(glm::translate(glm::dmat4(1), {20, 0, 0}), turned, glm::dvec3(0, 0, 1)), glm::dvec3(1, 5, 5));
        geometry->normal_maps = {map};
        geometry->materials[0].normal_map = 0;
        return test::makePing(config, test::makeSnapshot(geometry)).bins;
    };
    const std::vector<float> bent = ping(relief.map), plain = ping(test::flatMap());
    const glm::dvec2 ahead(std::cos(laid.turned), std::sin(laid.turned) * (laid.is_left ? 1 : -1));
    double echo = 0, expected = 0, all = 0;
    for (size_t k = 0; k < plain.size(); ++k) {
        if (plain[k] == 0) continue;
        const double cosine = std::min(20 * std::cos(turned) / (0.1 * (static_cast<double>(k) + 0.5)), 1.0);
        echo += double{bent[k]}, all += double{plain[k]};
        expected += double{plain[k]} * relief.computeMeanFacing(std::acos(cosine), ahead) / cosine;
    }
    return {echo / all, expected / all};
}

}  // namespace

TEST(NormalMapTest, ReliefFinerThanASampleEchoesByTheMeanOfTheNormalsThatFaceTheSonar) {
    std::mt19937 random(11);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    double most = 0;
    for (int trial = 0; trial < 24; ++trial) {
        const double steepest = between(0.05, 0.8), turned = types::radians(between(0, 83));
        std::normal_distribution<double> bell(0, steepest / 2);
        int texel = 0;
        const FineRelief relief(between(0, 2 * std::numbers::pi), [&] {
            if (trial % 3 == 0) return std::clamp(bell(random), -1.4, 1.4);
            if (trial % 3 == 1) return between(-steepest, steepest);
            return steepest * std::sin(texel++ * (2 * std::numbers::pi / 16));  // ripples of 16 texels
        });
        const auto [echo, expected] = compareRelief(relief, turned, {between(0, 2 * std::numbers::pi), trial % 2 == 0});
        EXPECT_NEAR(echo, expected, 0.06 * expected) << trial << ": " << steepest << " rad at " << turned;
        most = std::max(most, expected);
    }
    EXPECT_GT(most, 1.4) << "relief that faces the sonar makes grazing walls louder";
}

TEST(NormalMapTest, RaysAverageTheSameAreaOfAMapOnAStretchedWall) {
    SonarConfig config = test::getSonar({.beams = 24, .width_deg = 24, .bins = 300, .rows = 64, .columns = 2});
    config.visibility = Visibility::Cpu;
    const auto echo = [&](const glm::dvec3& size, bool by_object) {
        return test::makePing(config, test::makeSnapshot(bumpyWall(size, by_object))).bins;
    };
    for (const glm::dvec3 size : {glm::dvec3(1, 5, 5), {1, 1, 8}, {1, 9, 2}, {4, 5, 5}, {0.1, 6, 4}}) {
        const std::vector<float> stretched = echo(size, true), made = echo(size, false);
        const double loudest = double{*std::ranges::max_element(made)};
        ASSERT_GT(loudest, 0);
        // Rounding may take one sample in some thousand to the next halving of the map.
        for (size_t k = 0; k < made.size(); ++k) EXPECT_NEAR(stretched[k], made[k], 2e-3 * loudest) << k;
    }
    const std::vector<float> fine = echo({1, 5, 5}, true), coarse = echo({1, 60, 60}, true);
    EXPECT_NE(fine, coarse) << "another part of the map, which must show";
}

TEST(NormalMapTest, AnEchoIsProportionalToTheCosineOfTheMappedNormal) {
    const std::vector<float> plain = getEcho(wallWithNormalsAt(0));
    ASSERT_GT(plain[200], 0);
    for (const double degrees : {20.0, 45.0, 70.0, -45.0}) {
        const std::vector<float> bent = getEcho(wallWithNormalsAt(types::radians(degrees)));
        EXPECT_NEAR(bent[200] / plain[200], std::cos(types::radians(degrees)), 0.01) << degrees;
        for (size_t k = 0; k < bent.size(); ++k) EXPECT_EQ(bent[k] > 0, plain[k] > 0) << k;
    }
}

TEST(NormalMapTest, ASurfaceThatAMapTurnsAwayIsAlmostSilent) {
    EXPECT_LT(getEcho(wallWithNormalsAt(types::radians(120)))[200], 1e-5 * getEcho(wallWithNormalsAt(0))[200]);
}

}  // namespace insonify::sonar
