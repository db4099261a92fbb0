// Echoes of straight edges (ACOUSTICS.md 3.12).
#include <gmock/gmock.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

#include "components/acoustics/Wedge.hpp"
#include "components/framework/config/ConfigReader.hpp"
#include "components/framework/config/YamlText.hpp"
#include "components/sonar/multipath/EdgeEchoes.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/sonar/surfaces/StraightEdges.hpp"
#include "tests/support/EveryRenderer.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/Weightings.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using acoustics::WedgeFaces;
using std::numbers::pi;
using testing::HasSubstr;
using types::radians;

constexpr double wavelength = 0.01;  ///< Wavelength of the sonars here [m].
constexpr double sharp = pi / 3;     ///< The default turn [rad].

/** One beam of 40 by 40 deg at 100 kHz in water of 1000 m/s, bins of 2 cm, with the effect. */
SonarConfig edgeSonar(double range = 12) {
    SonarConfig config = test::getSonar({.beams = 1,
                                         .width_deg = 40,
                                         .height_deg = 40,
                                         .bins = static_cast<int>(range / 0.02),
                                         .bin = 0.02,
                                         .rows = 256,
                                         .columns = 256});
    config.visibility = Visibility::Cpu;
    config.frequency_khz = 100;
    config.effects["edge_diffraction"] = {};
    return config;
}

SonarConfig without(SonarConfig config) {
    config.effects.clear();
    return config;
}

/** Placed meshes of a smooth material without diffuse scattering. */
types::GeometryPtr smooth(std::vector<types::Mesh> meshes, std::vector<glm::dmat4> places, float reflection = 1,
                          float slope = 0) {
    auto geometry = std::make_shared<types::Geometry>();
    types::Material& material = geometry->materials.emplace_back();
    material.lambert_db = -300;
    material.reflection = reflection;
    material.roughness_slope = slope;
    for (size_t i = 0; i < meshes.size(); ++i)
        geometry->objects.push_back({"object_" + std::to_string(i), static_cast<int>(i), places[i]});
    geometry->meshes = std::move(meshes);
    return geometry;
}

glm::dmat4 placed(const glm::dvec3& at, double pitch = 0, double yaw = 0) {
    return glm::rotate(glm::rotate(glm::translate(glm::dmat4(1), at), yaw, {0, 0, 1}), pitch, {0, 1, 0});
}

/** A sheet across x and y about the origin. */
types::Mesh sheet(float x, float y) { return test::quad({-x / 2, -y / 2, 0}, {x, 0, 0}, {0, y, 0}); }

/** A box about the origin. Each face has its own vertices and count x count quads, or another number per face. */
types::Mesh box(glm::vec3 size, std::array<int, 6> counts) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2, count = counts[static_cast<size_t>(face)];
        const float side = face % 2 ? 0.5f : -0.5f;
        const auto first = static_cast<uint32_t>(positions.size());
        for (int i = 0; i <= count; ++i)
            for (int j = 0; j <= count; ++j) {
                glm::vec3 p(0);
                p[axis] = side;
                p[(axis + 1) % 3] = static_cast<float>(i) / static_cast<float>(count) - 0.5f;
                p[(axis + 2) % 3] = static_cast<float>(j) / static_cast<float>(count) - 0.5f;
                positions.push_back(p * size);
            }
        for (int i = 0; i < count; ++i)
            for (int j = 0; j < count; ++j) {
                const uint32_t a = first + static_cast<uint32_t>(i * (count + 1) + j),
                               b = a + static_cast<uint32_t>(count) + 1;
                if (side > 0)
                    indices.insert(indices.end(), {a, b, b + 1, a, b + 1, a + 1});
                else
                    indices.insert(indices.end(), {a, b + 1, b, a, a + 1, b + 1});
            }
    }
    return test::getMesh(positions, indices);
}
types::Mesh box(glm::vec3 size, int count = 1) { return box(size, {count, count, count, count, count, count}); }

/** A prism of n sides, with caps. */
types::Mesh prism(int n, float radius, float height) {
    std::vector<glm::vec3> positions{{0, 0, 0}, {0, 0, height}};
    std::vector<uint32_t> indices;
    for (int k = 0; k < n; ++k)
        for (const float z : {0.0f, height}) {
            const double angle = 2 * pi * k / n;
            positions.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
        }
    const auto at = [n](int k, int top) { return static_cast<uint32_t>(2 + 2 * (k % n) + top); };
    for (int k = 0; k < n; ++k) {
        const uint32_t a = at(k, 0), b = at(k + 1, 0), c = at(k + 1, 1), d = at(k, 1);
        indices.insert(indices.end(), {a, b, c, a, c, d, 0, b, a, 1, d, c});
    }
    return test::getMesh(positions, indices);
}

/** Sum of the bins within 6 cm of a range. */
double echoAt(const types::Sonar& ping, double range) {
    double sum = 0;
    for (size_t i = 0; i < ping.bins.size(); ++i) {
        const double centre = (static_cast<double>(i % ping.bin_count) + 0.5) * 0.02;
        if (std::abs(centre - range) < 0.06) sum += double{ping.bins[i]};
    }
    return sum;
}
double decibels(double x) { return 10 * std::log10(x); }

/** 1 / (1 / L^2 + 2 / (lambda r)) [m^2]. */
double coherentSquare(double length, double range) { return 1 / (1 / (length * length) + 2 / (wavelength * range)); }

std::optional<Omitted> omitted(const SonarRenderer& renderer) {
    for (const Omitted& what : renderer.omissions())
        if (what.effect == "edge diffraction") return what;
    return {};
}

TEST(StraightEdgesTest, ABoxHasTwelveEdgesWithAnyTriangles) {
    const types::Mesh plain = box({1, 2, 3});
    const StraightEdges twelve = straightEdges(plain, glm::dmat3(1), sharp);
    ASSERT_EQ(twelve.edges.size(), 12u);
    const auto lengths = [](const StraightEdges& found) {
        std::vector<double> all;
        for (const StraightEdge& edge : found.edges) all.push_back(glm::distance(edge.from, edge.to));
        std::ranges::sort(all);
        return all;
    };
    for (const types::Mesh& mesh : {box({1, 2, 3}, 5), box({1, 2, 3}, {1, 2, 4, 1, 8, 2})}) {
        const StraightEdges found = straightEdges(mesh, glm::dmat3(1), sharp);
        EXPECT_THAT(lengths(found), testing::Pointwise(testing::DoubleNear(1e-6), lengths(twelve)));
        EXPECT_THAT(found.encloses, testing::Each(1));
        for (const StraightEdge& edge : found.edges) {
            EXPECT_NEAR(glm::dot(edge.faces[0].inward, edge.faces[1].inward), 0, 1e-6);
            for (const EdgeFace& face : edge.faces) {
                EXPECT_TRUE(face.is_enclosed);
                EXPECT_NEAR(face.width, std::round(face.width), 1e-6);
            }
        }
    }
}

TEST(StraightEdgesTest, CurvesAndSmoothBodiesHaveNoEdges) {
    EXPECT_TRUE(straightEdges(test::sphere(1, 16), glm::dmat3(1), sharp).edges.empty());
    EXPECT_TRUE(straightEdges(prism(32, 0.3f, 1), glm::dmat3(1), sharp).edges.empty()) << "rims";
    EXPECT_TRUE(straightEdges(test::disc(5, 1, 64), glm::dmat3(1), sharp).edges.empty());
    EXPECT_EQ(straightEdges(prism(6, 0.3f, 1), glm::dmat3(1), 0.9 * sharp).edges.size(), 18u) << "hexagons";
    EXPECT_EQ(straightEdges(prism(8, 0.3f, 1), glm::dmat3(1), 0.7).edges.size(), 8u) << "sides turn by 45 deg";
    EXPECT_EQ(straightEdges(sheet(1, 2), glm::dmat3(1), sharp).edges.size(), 4u);
}

TEST(StraightEdgesTest, AngleAndLengthAreThoseOfTheWorld) {
    glm::dmat3 flatter(1);
    flatter[2][2] = 0.1;  // a roof of 45 deg becomes one of 6
    const types::Mesh roof = test::getMesh({{-1, 0, 0}, {1, 0, 0}, {-1, 1, 1}, {1, 1, 1}, {-1, 2, 0}, {1, 2, 0}},
                                           {0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4});
    EXPECT_EQ(straightEdges(roof, glm::dmat3(1), sharp).edges.size(), 7u);
    EXPECT_EQ(straightEdges(roof, flatter, sharp).edges.size(), 6u) << "without the ridge";
}

TEST(EdgeDiffractionTest, ASoftSheetEdgeOnIsItsNearEdge) {
    const double length = 0.1, range = 10.01;
    const auto scene = smooth({sheet(1, static_cast<float>(length))}, {placed({range + 0.5, 0, 0})}, -1);
    const double expected = coherentSquare(length, range) / std::pow(2 * pi, 2) / std::pow(range, 4);  // D = -1
    for (const SonarConfig& way : test::everyRenderer(edgeSonar())) {
        const types::Sonar ping = test::makePing(way, test::makeSnapshot(scene));
        EXPECT_NEAR(decibels(echoAt(ping, range) / expected), 0, 0.01);
        EXPECT_LT(test::computeSum(ping), 1.01 * expected) << "nothing else";
    }
    EXPECT_EQ(test::computeSum(test::makePing(without(edgeSonar()), test::makeSnapshot(scene))), 0);
    const auto rigid = smooth({sheet(1, static_cast<float>(length))}, {placed({range + 0.5, 0, 0})}, 1);
    EXPECT_LT(test::computeSum(test::makePing(edgeSonar(), test::makeSnapshot(rigid))), 1e-3 * expected)
        << "a thin rigid sheet does not affect sound along its face";
}

TEST(EdgeDiffractionTest, ATiltedStripEchoesFromBothEdgesByKellersCoefficients) {
    const double width = 0.6, range = 8;
    for (const double length : {0.1, 3.0})  // far from the near field, and in it
        for (const float reflection : {1.0f, -0.5f})
            for (const double tilt_deg : {20.0, 40.0, 65.0}) {
                const double tilt = radians(tilt_deg);
                const auto scene = smooth({sheet(static_cast<float>(width), static_cast<float>(length))},
                                          {placed({range, 0, 0}, tilt)}, reflection);
                const types::Sonar ping = test::makePing(edgeSonar(), test::makeSnapshot(scene));
                double sum = 0;
                for (const double side : {-1.0, 1.0}) {
                    const glm::dvec3 edge{range + side * width / 2 * std::cos(tilt), 0,
                                          -side * width / 2 * std::sin(tilt)};
                    const double away = glm::length(edge);
                    const double from_face =
                        std::acos(side * glm::dot(edge / away, {std::cos(tilt), 0, -std::sin(tilt)}));
                    const double d =
                        acoustics::wedgeEcho(reflection > 0 ? WedgeFaces::Rigid : WedgeFaces::Soft, 2 * pi, from_face)
                            .total();
                    const double expected =
                        std::pow(reflection * d / (2 * pi), 2) * coherentSquare(length, away) / std::pow(away, 4);
                    sum += expected;
                    EXPECT_NEAR(decibels(echoAt(ping, away) / expected), 0, 0.3)
                        << length << " m, " << reflection << ", " << tilt_deg << " deg, side " << side;
                }
                EXPECT_NEAR(decibels(test::computeSum(ping) / sum), 0, 0.3) << "the rest of the plate is silent";
            }
}

TEST(EdgeDiffractionTest, AnEdgeEchoesAsAPointTargetOfItsStrength) {
    const double length = 0.1, range = 6.013;
    const auto scene = smooth({sheet(1, static_cast<float>(length))}, {placed({range + 0.5, 0, 0})}, -1);
    types::Snapshot target = test::makeSnapshot(test::openWater(), {0, 0, 0}, 0.07, 0.05);
    target.targets = {{{range, 0, 0}, decibels(coherentSquare(length, range) / std::pow(2 * pi, 2))}};
    for (const bool coherent : {false, true}) {
        SonarConfig config = edgeSonar();
        config.beam_count = 20;
        config.quality.rows = config.quality.columns_per_beam = 16;
        config.pulse.emplace().bandwidth_khz = 10;
        config.beam_pattern.emplace().receive.azimuth = test::getLaw(acoustics::Weighting::Hann, 3);
        if (coherent) config.speckle.emplace().coherent = true;
        const types::Sonar edge = test::makePing(config, test::makeSnapshot(scene, {0, 0, 0}, 0.07, 0.05));
        const types::Sonar point = test::makePing(without(config), target);
        const double loudest = double{*std::ranges::max_element(point.bins)};
        ASSERT_GT(loudest, 0);
        for (size_t i = 0; i < edge.bins.size(); ++i) ASSERT_NEAR(edge.bins[i], point.bins[i], 1e-3 * loudest) << i;
    }
}

TEST(EdgeDiffractionTest, AFaceAlongItsNormalKeepsItsTargetStrength) {
    const auto scene = smooth({sheet(0.1f, 0.1f)}, {placed({10, 0, 0}, pi / 2)});
    const double expected = std::pow(0.01 / wavelength, 2) / 1e4;
    SonarConfig narrow = edgeSonar();
    narrow.field_of_view_deg = narrow.beam_height_deg = 4;
    const double plain = test::computeSum(test::makePing(without(narrow), test::makeSnapshot(scene)));
    const double with = test::computeSum(test::makePing(narrow, test::makeSnapshot(scene)));
    EXPECT_NEAR(decibels(plain / expected), 0, 0.5);
    EXPECT_NEAR(decibels(with / plain), 0, 0.2);
}

TEST(EdgeDiffractionTest, DoesNotDependOnTheTriangles) {
    std::mt19937 random(3);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int trial = 0; trial < 12; ++trial) {
        const glm::vec3 size(uniform(0.2, 1), uniform(0.2, 1), uniform(0.2, 1));
        const glm::dmat4 place =
            placed({uniform(3, 9), uniform(-0.5, 0.5), uniform(-0.5, 0.5)}, uniform(-3, 3), uniform(-3, 3));
        std::vector<float> first;
        for (const types::Mesh& mesh : {box(size), box(size, 4), box(size, {1, 2, 4, 1, 8, 2})}) {
            const types::Sonar ping = test::makePing(edgeSonar(), test::makeSnapshot(smooth({mesh}, {place})));
            if (first.empty()) first = ping.bins;
            const double loudest = double{*std::ranges::max_element(first)};
            ASSERT_GT(loudest, 0);
            for (size_t i = 0; i < first.size(); ++i) ASSERT_NEAR(ping.bins[i], first[i], 2e-3 * loudest) << trial;
        }
    }
}

TEST(EdgeDiffractionTest, HiddenEdgesAreSilent) {
    const types::Mesh wall = test::quad({0, -2, -2}, {0, 4, 0}, {0, 0, 4}), block = box({0.5f, 0.5f, 0.5f});
    const glm::dmat4 far = placed({8, 0, 0}, 0.3, 0.4), before = placed({5, 0, 0});
    const types::Sonar alone = test::makePing(edgeSonar(), test::makeSnapshot(smooth({wall}, {before})));
    EXPECT_EQ(test::makePing(edgeSonar(), test::makeSnapshot(smooth({wall, block}, {before, far}))).bins, alone.bins);
    SonarRenderer renderer(edgeSonar(), smooth({block}, {far}));
    types::Sonar ping;
    types::Snapshot snapshot = test::makeSnapshot(smooth({block}, {far}));
    renderer.render(snapshot, ping);
    EXPECT_EQ(renderer.othersReceived(), 9u) << "of twelve edges three are behind the block";
    const auto left = omitted(renderer);
    ASSERT_TRUE(left);
    EXPECT_EQ(left->reason, Reason::OutOfView);
    EXPECT_EQ(left->value, 3);
}

TEST(EdgeDiffractionTest, AnObjectThatMovesTakesItsEdgesAlong) {
    const types::Mesh block = box({0.5f, 0.4f, 0.3f});
    const glm::dmat4 there = placed({7, 0.3, -0.2}, 0.4, 1.1);
    types::Snapshot moved = test::makeSnapshot(smooth({block}, {placed({5, 0, 0})}));
    moved.moved = {{0, there}};
    const types::Sonar ping = test::makePing(edgeSonar(), moved);
    const types::Sonar still = test::makePing(edgeSonar(), test::makeSnapshot(smooth({block}, {there})));
    const double loudest = double{*std::ranges::max_element(still.bins)};
    ASSERT_GT(loudest, 0);
    for (size_t i = 0; i < still.bins.size(); ++i) ASSERT_NEAR(ping.bins[i], still.bins[i], 1e-4 * loudest) << i;
}

TEST(EdgeDiffractionTest, ASceneWithoutEdgesKeepsItsBitsAndReportsWhy) {
    const auto expectOmitted = [](const types::GeometryPtr& scene, const char* words) {
        SonarRenderer renderer(edgeSonar(), scene);
        types::Sonar ping;
        renderer.render(test::makeSnapshot(scene), ping);
        EXPECT_EQ(ping.bins, test::makePing(without(edgeSonar()), test::makeSnapshot(scene)).bins);
        EXPECT_GT(test::computeSum(ping), 0);
        const auto left = omitted(renderer);
        const Omitted* planned = renderer.renderPlan().findOmitted("edge diffraction");
        const Omitted what = left ? *left : planned ? *planned : Omitted{};
        EXPECT_EQ(what.reason, Reason::NoneInScene);
        ASSERT_TRUE(what.words);
        EXPECT_THAT(what.words(what, {}), HasSubstr(words));
    };
    expectOmitted(test::makeScene({test::ground(-2), box({1, 1, 1})}, 0, {{0, 0, 0}, {6, 0, 0}}), "no material");
    expectOmitted(smooth({test::sphere(0.5, 24)}, {placed({6, 0, 0})}), "no straight edge");
}

TEST(EdgeDiffractionTest, RejectsInvalidConfigurations) {
    const auto findDiagnostic = [](const char* yaml) {
        framework::ConfigReader reader("sonar.yml");
        SonarConfig config;
        reader.read(YAML::Load(yaml), "", config);
        std::string all;
        for (const auto& each : reader.diagnostics()) all += each.path + ": " + each.message + "\n";
        return all;
    };
    EXPECT_EQ(findDiagnostic("{frequency_khz: 300, effects: {edge_diffraction: {}}}"), "");
    EXPECT_EQ(findDiagnostic("{frequency_khz: 300, effects: {edge_diffraction: {min_turn_deg: 30}}}"), "");
    EXPECT_THAT(findDiagnostic("{effects: {edge_diffraction: {}}}"),
                HasSubstr("effects.edge_diffraction: needs frequency_khz"));
    EXPECT_THAT(findDiagnostic("{model: cerqueira2017, effects: {edge_diffraction: {}}}"),
                HasSubstr("it belongs to physical"));
    EXPECT_THAT(findDiagnostic("{frequency_khz: 300, motion_in_ping: true, effects: {edge_diffraction: {}}}"),
                HasSubstr("no motion within a ping"));
    EXPECT_THAT(findDiagnostic("{frequency_khz: 300, effects: {edge_diffraction: {min_turn_deg: 0}}}"),
                HasSubstr("effects.edge_diffraction.min_turn_deg: is 0; must be 1 to 180 deg"));
    EXPECT_THAT(findDiagnostic("{frequency_khz: 300, effects: {edge_diffraction: {turn: 60}}}"),
                HasSubstr("is no number of this effect; did you mean min_turn_deg?"));
    EXPECT_THAT(findDiagnostic("{frequency_khz: 300, effects: {edge_difraction: {}}}"), HasSubstr("edge_diffraction"));
}

TEST(EdgeDiffractionTest, EverythingIsFiniteForRandomBoxesAndSonarsOnTheirEdges) {
    std::mt19937 random(11);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int trial = 0; trial < 60; ++trial) {
        const glm::dvec3 half(uniform(0.001, 2), uniform(0.001, 2), uniform(0.001, 2));
        SonarConfig config = edgeSonar();
        config.quality.rows = config.quality.columns_per_beam = 32;
        if (trial % 3 == 0) config.speckle.emplace().coherent = true;
        const glm::dmat4 place =
            placed({uniform(-3, 3), uniform(-3, 3), uniform(-3, 3)}, uniform(-3, 3), uniform(-3, 3));
        const auto scene =
            smooth({box(glm::vec3(2.0 * half))}, {place}, trial % 2 ? 0.9f : -0.9f, trial % 5 ? 0 : 0.1f);
        const glm::dvec3 onto[] = {half,                          // a corner
                                   {half.x, half.y, 0},           // an edge
                                   {half.x, half.y, half.z + 1},  // its line
                                   {half.x, 0, 0},                // a face
                                   {half.x + 1, half.y, 0},       // its plane
                                   {uniform(-3, 3), uniform(-3, 3), uniform(-3, 3)}};
        types::Snapshot snapshot =
            test::makeSnapshot(scene, place * glm::dvec4(onto[trial % 6], 1), uniform(-3, 3), uniform(-1, 1));
        const types::Sonar ping = test::makePing(config, snapshot);
        for (const float bin : ping.bins) ASSERT_TRUE(std::isfinite(bin) && bin >= 0) << trial;
    }
}

/** An edge of a sheet along y at the origin, whose face extends along x. */
PlacedEdge getEdge(double length, double slope) {
    return {.from = {0, -length / 2, 0},
            .to = {0, length / 2, 0},
            .inward = {glm::dvec3(1, 0, 0), glm::dvec3(1, 0, 0)},
            .widths = {1, 1},
            .are_enclosed = {true, true},
            .reflection = 1,
            .square_slope = slope * slope,
            .wavelength = wavelength};
}

double computeSection(const PlacedEdge& edge, const glm::dvec3& sonar) {
    std::vector<EdgeEcho> echoes;
    appendEdgeEchoes(edge, sonar, 0.01, echoes);
    double sum = 0;
    for (const EdgeEcho& echo : echoes) sum += echo.section;
    return sum;
}

TEST(EdgeEchoesTest, ALongEdgeEchoesAsItsFresnelZoneWithAnyRelief) {
    const glm::dvec3 sonar{6, 0, 8};
    const double expected = wavelength * 10 / 2 * std::pow(getEdge(1, 0).coefficient(sonar) / (2 * pi), 2);
    for (const double slope : {0.0, 0.003, 0.03, 0.2})
        EXPECT_NEAR(decibels(computeSection(getEdge(100, slope), sonar) / expected), 0, 0.15) << slope;
}

TEST(EdgeEchoesTest, FarAwayOverAllAnglesReliefKeepsTheSum) {
    const double length = 0.3, range = 200;
    const auto sumOver = [&](double slope) {
        double sum = 0;
        for (double angle = -0.6; angle < 0.6; angle += 1e-4)
            sum += 1e-4 *
                   computeSection(getEdge(length, slope),
                                  range * glm::dvec3(-0.6 * std::cos(angle), std::sin(angle), 0.8 * std::cos(angle)));
        return sum;
    };
    const double mirror = sumOver(0);
    for (const double slope : {0.02, 0.1}) EXPECT_NEAR(decibels(sumOver(slope) / mirror), 0, 0.6) << slope;
}

TEST(EdgeEchoesTest, AHollowEdgeIsSilent) {
    PlacedEdge edge = getEdge(1, 0);
    edge.inward[1] = {0, 0, 1};
    EXPECT_EQ(edge.coefficient({5, 0, 5}), 0) << "between the faces";
    EXPECT_NE(edge.coefficient({-5, 0, -5}), 0);
    EXPECT_NE(edge.coefficient({5, 0, -5}), 0);
}

}  // namespace
}  // namespace insonify::sonar
