// Echoes by mirrors compared with the image method, computed here from the sonar equation itself (ACOUSTICS.md 5.23).
#include <gmock/gmock.h>

#include <array>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "components/sonar/multipath/Mirrors.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/EveryRenderer.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "types/geometry/Angle.hpp"
#include "types/samples/SonarReturns.hpp"

namespace insonify::sonar {
namespace {

using std::numbers::pi;
using test::makePing;
using test::openWater;
using types::radians;

/** Bins of 0.1 m to 30 m, rays that look 60 deg up and down. */
SonarConfig surfaceSonar(double fov_deg, int beams) {
    return test::getSonar(
        {.beams = beams, .width_deg = fov_deg, .height_deg = 120, .bins = 300, .rows = 512, .columns = 2});
}

SonarConfig mirrored(SonarConfig config, double wind = 0, int bounces = 1) {
    config.multipath.emplace();
    config.multipath->surface.emplace().wind_m_s = wind;
    config.multipath->bounces = bounces;
    return config;
}

types::Snapshot under(double surface, types::GeometryPtr geometry) {
    types::Snapshot snapshot = test::makeSnapshot(std::move(geometry));
    snapshot.water_surface = surface;
    return snapshot;
}

types::Snapshot withTarget(double surface, glm::dvec3 position, types::GeometryPtr geometry = openWater()) {
    types::Snapshot snapshot = under(surface, std::move(geometry));
    snapshot.targets = {{position, 0}};
    return snapshot;
}

double decibels(double ratio) { return 10 * std::log10(ratio); }

/** Returns the difference of two pings, bin by bin. */
std::vector<double> difference(const types::Sonar& with, const types::Sonar& without) {
    std::vector<double> all;
    for (size_t i = 0; i < with.bins.size(); ++i) all.push_back(double{with.bins[i]} - double{without.bins[i]});
    return all;
}

/** Returns the bins of a beam that are not 0. */
std::vector<size_t> receivedBins(const types::Sonar& ping, uint32_t beam = 0) {
    std::vector<size_t> bins;
    for (size_t k = 0; k < ping.bin_count; ++k)
        if (ping.bins[beam * ping.bin_count + k] > 0) bins.push_back(k);
    return bins;
}

TEST(MultipathTest, APointTargetUnderAFlatSurfaceHasThreeReturns) {
    const SonarConfig config = surfaceSonar(40, 1);
    const auto ping = makePing(mirrored(config), withTarget(3, {12, 0, -1}));
    const double r1 = std::hypot(12, 1), r2 = std::hypot(12, 7);
    const std::vector<double> ranges{r1, (r1 + r2) / 2, r2};
    const std::vector<double> expected{std::pow(r1, -4), 2 / (r1 * r1 * r2 * r2), std::pow(r2, -4)};
    const auto received = receivedBins(ping);
    ASSERT_EQ(received.size(), 3u);
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR((static_cast<double>(received[i]) + 0.5) * 0.1, ranges[i], 0.05 + 1e-9);
        EXPECT_NEAR(decibels(ping.bins[received[i]] / expected[i]), 0, 0.01) << i;
    }
    // Counting the mixed path once for both directions would give 3 dB less.
    EXPECT_GT(decibels(ping.bins[received[1]] / (expected[1] / 2)), 2.9);
}

TEST(MultipathTest, TheDirectEchoOfATargetIsTheSameBitForBit) {
    const SonarConfig config = surfaceSonar(40, 4);
    const auto with = makePing(mirrored(config), withTarget(3, {12, 2, -1}));
    const auto without = makePing(config, withTarget(3, {12, 2, -1}));
    for (size_t i = 0; i < without.bins.size(); ++i)
        if (without.bins[i] > 0) {
            EXPECT_EQ(with.bins[i], without.bins[i]);
        }
    EXPECT_EQ(receivedBins(without, 2).size(), 1u);
    EXPECT_EQ(receivedBins(with, 2).size(), 3u);
}

/** Returns the number of returns of a target with a plate at a place. */
size_t returnsWith(types::Mesh plate) {
    auto config = mirrored(surfaceSonar(20, 1));
    auto scene = test::makeScene({std::move(plate)}, -200);
    return receivedBins(makePing(config, withTarget(3, {12, 0, -1}, scene))).size();
}

TEST(MultipathTest, EachLegOfATargetsPathsIsHiddenSeparately) {
    const auto plateAt = [](glm::dvec3 at) {
        return test::quad(glm::vec3(at) - glm::vec3(0, 0.2f, 0.2f), {0, 0.4f, 0}, {0, 0, 0.4f});
    };
    EXPECT_EQ(returnsWith(plateAt({-50, 0, 0})), 3u);
    EXPECT_EQ(returnsWith(plateAt({6, 0, -0.5})), 1u) << "on the direct path: the path by the mirror both ways remains";
    const double bounce = 12.0 * 3 / 7;  // where the path meets the surface
    EXPECT_EQ(returnsWith(plateAt({bounce / 2, 0, 1.5})), 1u) << "up to the surface: the direct path remains";
    EXPECT_EQ(returnsWith(plateAt({(bounce + 12) / 2, 0, 1})), 1u) << "down from the surface";
    EXPECT_EQ(returnsWith(plateAt({bounce, 0, 5})), 3u) << "above the surface nothing hides anything";
}

TEST(MultipathTest, DirectionsOutsideOfTheApertureAreNeitherSentNorReceived) {
    auto config = mirrored(surfaceSonar(40, 1));
    config.beam_height_deg = 50;  // the path by the surface rises by 30.3 deg
    EXPECT_EQ(receivedBins(makePing(config, withTarget(3, {12, 0, -1}))).size(), 1u);
    config.beam_height_deg = 62;
    EXPECT_EQ(receivedBins(makePing(config, withTarget(3, {12, 0, -1}))).size(), 3u);
}

TEST(MultipathTest, ATargetAboveTheSurfaceHasNoEcho) {
    const auto snapshot = withTarget(3, {12, 0, 4});
    EXPECT_EQ(receivedBins(makePing(mirrored(surfaceSonar(40, 1)), snapshot)).size(), 0u);
    EXPECT_EQ(receivedBins(makePing(surfaceSonar(40, 1), snapshot)).size(), 1u);
}

TEST(MultipathTest, TransmitAndReceivePatternsApplyToTheirOwnPaths) {
    auto config = mirrored(surfaceSonar(40, 1));
    acoustics::BeamLaw narrow, wide;
    narrow.weighting = wide.weighting = acoustics::Weighting::Gaussian;
    narrow.width_deg = 20;
    wide.width_deg = 60;
    config.beam_pattern.emplace();
    config.beam_pattern->transmit.elevation = narrow;
    config.beam_pattern->receive.elevation = wide;
    config.beam_pattern->floor_db = -150;
    const auto ping = makePing(config, withTarget(3, {12, 0, -1}));
    const double r1 = std::hypot(12, 1), r2 = std::hypot(12, 7);
    const auto power = [](const acoustics::BeamLaw& law, double angle) {
        return acoustics::BeamPattern(law).power(angle);
    };
    const double down = -std::asin(1 / r1), up = std::asin(7 / r2);
    const double expected =
        (power(narrow, down) * power(wide, up) + power(narrow, up) * power(wide, down)) / (r1 * r1 * r2 * r2);
    const double product = 2 *
                           std::sqrt(power(narrow, down) * power(wide, up) * power(narrow, up) * power(wide, down)) /
                           (r1 * r1 * r2 * r2);
    const double received = ping.bins[static_cast<size_t>((r1 + r2) / 2 / 0.1)];
    EXPECT_NEAR(decibels(received / expected), 0, 0.01);
    EXPECT_GT(std::abs(decibels(received / product)), 1) << "the root of both two-way patterns differs";
}

/** Energies of a flat bottom 4 m below by a surface 2 m above, in coarse bins of 2 m, by a sum over the bottom. */
struct Bottom {
    std::vector<double> twice = std::vector<double>(15), once = std::vector<double>(15);

    explicit Bottom(double aperture_deg, double wedge) {
        const double half = radians(aperture_deg) / 2, step = 1e-3;
        for (double out = step / 2; out < 60; out += step) {
            const double r1 = std::hypot(out, 4), r2 = std::hypot(out, 8), area = out * wedge * step;
            if (std::atan2(8, out) > half) continue;
            add(twice, r2, area * std::pow(8 / r2, 2) * std::pow(r2, -4));
            if (std::atan2(4, out) <= half) add(once, (r1 + r2) / 2, 2 * area * 4 / r1 * 8 / r2 / (r1 * r1 * r2 * r2));
        }
    }
    static void add(std::vector<double>& bins, double range, double energy) {
        if (range < 30) bins[static_cast<size_t>(range / 2)] += energy;
    }
};

TEST(MultipathTest, ABottomByTheSurfaceIsTheSumOverItsArea) {
    const SonarConfig config = surfaceSonar(8, 4);
    const auto scene = test::makeScene({test::ground(-4)});
    const auto ghosts = difference(makePing(mirrored(config), under(2, scene)), makePing(config, under(2, scene)));
    const Bottom expected(120, radians(8));
    for (size_t k = 4; k < 15; ++k) {
        double received = 0;
        for (size_t beam = 0; beam < 4; ++beam)
            for (size_t i = 20 * k; i < 20 * k + 20; ++i) received += ghosts[beam * 300 + i];
        EXPECT_NEAR(decibels(received / (expected.once[k] + expected.twice[k])), 0, 0.05) << k;
        EXPECT_GT(std::abs(decibels(received / (expected.once[k] / 2 + expected.twice[k]))), 1) << k;
    }
}

TEST(MultipathTest, DirectEchoesOfASceneAreTheSameBitForBit) {
    const SonarConfig config = surfaceSonar(90, 16);
    const auto scene = test::makeScene({test::ground(-4), test::sphere(1, 24)}, 0, {{}, {9, 1, -1}});
    const auto with = makePing(mirrored(config), under(2, scene)), without = makePing(config, under(2, scene));
    size_t same = 0, more = 0;
    for (size_t i = 0; i < with.bins.size(); ++i) {
        EXPECT_GE(with.bins[i], without.bins[i]);
        (with.bins[i] == without.bins[i] ? same : more) += 1;
    }
    EXPECT_GT(more, 500u);
    for (size_t beam = 0; beam < 16; ++beam)
        for (size_t k = 0; k < 40; ++k)  // before any ghost
            EXPECT_EQ(with.bins[beam * 300 + k], without.bins[beam * 300 + k]);
    EXPECT_GT(same, 500u);
}

TEST(MultipathTest, ObjectsAboveTheSurfaceHaveNoEcho) {
    const auto wall = test::makeScene({test::wall(10)});
    const auto ping = makePing(mirrored(surfaceSonar(8, 1)), under(2, wall));
    // Direct echoes end where the wall meets the surface; farther away there are ghosts of the part below the surface.
    double dry = 0, all = 0;
    const auto open = makePing(surfaceSonar(8, 1), under(2, wall));
    for (size_t k = 0; k < 300; ++k) all += open.bins[k];
    for (size_t k = 0; k < 300; ++k) dry += ping.bins[k];
    EXPECT_GT(std::abs(dry / all - 1), 0.01);
    const auto beyond = under(2, test::makeScene({test::quad({10, -5, 3}, {0, 10, 0}, {0, 0, 3})}));
    EXPECT_TRUE(receivedBins(makePing(mirrored(surfaceSonar(8, 1)), beyond)).empty());
    EXPECT_FALSE(receivedBins(makePing(surfaceSonar(8, 1), beyond)).empty());
}

TEST(MultipathTest, NoBinChangesWithoutBouncesOrReflectors) {
    auto config = surfaceSonar(40, 8);
    const auto snapshot = under(2, test::makeScene({test::ground(-4)}));
    const auto without = makePing(config, snapshot).bins;
    EXPECT_EQ(makePing(mirrored(config, 0, 0), snapshot).bins, without);
    config.multipath.emplace();
    EXPECT_EQ(makePing(config, snapshot).bins, without);
    auto dry = snapshot;
    dry.water_surface.reset();
    EXPECT_EQ(makePing(mirrored(config), dry).bins, without);
    dry.water_surface = -1;  // above it
    EXPECT_EQ(makePing(mirrored(config), dry).bins, without);
    dry.water_surface = 31;  // beyond the range
    EXPECT_EQ(makePing(mirrored(config), dry).bins, without);
}

/** A material that is a mirror, or has a lobe, without diffuse scattering. */
types::Material makeMirror(float reflection) {
    types::Material material;
    material.lambert_db = -200;
    material.mirror = true;
    material.reflection = reflection;
    return material;
}

types::Material smoothPlate(float reflection = 1, float slope = 0) {
    types::Material material;
    material.lambert_db = -200;
    material.reflection = reflection;
    material.roughness_slope = slope;
    return material;
}

types::Material lambertian() {
    types::Material material;
    material.lambert_db = 0;
    return material;
}

struct Thing {
    types::Mesh mesh;
    types::Material material;
};

/** Makes one object with its own material for each mesh. */
types::GeometryPtr sceneWith(std::vector<Thing> things) {
    auto geometry = std::make_shared<types::Geometry>();
    for (Thing& thing : things) {
        for (types::Cluster& cluster : thing.mesh.clusters)
            cluster.material = static_cast<int>(geometry->materials.size());
        geometry->materials.push_back(thing.material);
        geometry->objects.push_back(
            {"thing_" + std::to_string(geometry->meshes.size()), static_cast<int>(geometry->meshes.size())});
        geometry->meshes.push_back(std::move(thing.mesh));
    }
    return geometry;
}

SonarConfig bouncing(SonarConfig config, int bounces = 1) {
    config.multipath.emplace().bounces = bounces;
    return config;
}

/** A wall along the axis to port, at y = 4. */
types::Mesh wallToPort(float from = -50, float to = 50) {
    return test::quad({from, 4, -50}, {to - from, 0, 0}, {0, 0, 100});
}

TEST(MultipathTest, AMirrorShowsATargetByItsReflection) {
    const SonarConfig config = bouncing(surfaceSonar(170, 1));
    const double r1 = std::hypot(12, 1), r2 = std::hypot(12, 7);
    const auto returns = [&](types::Mesh wall, float reflection) {
        auto snapshot = test::makeSnapshot(sceneWith({{std::move(wall), makeMirror(reflection)}}));
        snapshot.targets = {{{12, 1, 0}, 0}};
        return makePing(config, snapshot);
    };
    const auto half = returns(wallToPort(), -0.5f);
    const auto at = [&](double range) { return double{half.bins[static_cast<size_t>(range / 0.1)]}; };
    ASSERT_EQ(receivedBins(half).size(), 3u);
    EXPECT_NEAR(decibels(at((r1 + r2) / 2) / (2 * 0.25 / (r1 * r1 * r2 * r2))), 0, 0.01);
    EXPECT_NEAR(decibels(at(r2) / (0.0625 / std::pow(r2, 4))), 0, 0.01);
    EXPECT_EQ(receivedBins(returns(wallToPort(), 0)).size(), 3u) << "without a number all of the sound is reflected";
    const float met = 12 * 4.0f / 7;
    EXPECT_EQ(receivedBins(returns(wallToPort(-50, met - 0.1f), 1)).size(), 1u) << "the mirror ends before";
    EXPECT_EQ(receivedBins(returns(wallToPort(met - 0.1f, met + 0.1f), 1)).size(), 3u);
}

/** Sum of a beam's bins between two ranges. */
double between(const types::Sonar& ping, double from, double to, size_t beam = 0) {
    double sum = 0;
    for (auto k = static_cast<size_t>(from / 0.1); k < static_cast<size_t>(to / 0.1); ++k)
        sum += double{ping.bins[beam * ping.bin_count + k]};
    return sum;
}

/** A low fan to both sides, finely sampled. */
SonarConfig lowFan(int beams) {
    SonarConfig config = surfaceSonar(140, beams);
    config.beam_height_deg = 20;
    config.quality.columns_per_beam = 4096 / beams;
    return config;
}

/** A plate of Lambert's law that faces the sonar, and a mirror next to it, in beams to both. */
TEST(MultipathTest, APlateByAMirrorEchoesAtEachBearingOfArrival) {
    const SonarConfig config = lowFan(14);
    const auto plate = test::quad({12, -0.3f, -0.3f}, {0, 0.6f, 0}, {0, 0, 0.6f});
    const auto snapshot = test::makeSnapshot(sceneWith({{wallToPort(), makeMirror(1)}, {plate, lambertian()}}));
    const auto ghosts = makePing(bouncing(config), snapshot), plain = makePing(config, snapshot);
    double once = 0, twice = 0;  // by a double sum over the plate
    constexpr int steps = 200;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const glm::dvec3 p(12, 0.6 * (i + 0.5) / steps - 0.3, 0.6 * (j + 0.5) / steps - 0.3);
            const double r1 = glm::length(p), r2 = glm::distance(p, {0, 8, 0}), area = 0.36 / (steps * steps);
            once += 12 / r1 * 12 / r2 / (r1 * r1 * r2 * r2) * area;
            twice += std::pow(12 / r2, 2) * std::pow(r2, -4) * area;
        }
    const double r2 = std::hypot(12, 8), mean = (12 + r2) / 2;
    double ahead = 0, aside = 0, third = 0;
    for (size_t beam = 0; beam < 14; ++beam) {
        const double bearing = types::degrees(plain.bearings[beam].rad);
        const double here =
            between(ghosts, mean - 0.6, mean + 0.6, beam) - between(plain, mean - 0.6, mean + 0.6, beam);
        if (std::abs(bearing) < 8) ahead += here;
        if (std::abs(bearing - types::degrees(std::atan2(8, 12))) < 8) aside += here;
        third += between(ghosts, r2 - 0.6, r2 + 0.6, beam) - between(plain, r2 - 0.6, r2 + 0.6, beam);
    }
    EXPECT_NEAR(decibels(ahead / once), 0, 0.1);
    EXPECT_NEAR(decibels(aside / once), 0, 0.1);
    EXPECT_NEAR(decibels(third / twice), 0, 0.1);
    EXPECT_GT(std::abs(decibels(third / (twice * std::pow(r2 / 12, 4)))), 1) << "not as if it were no farther away";
}

TEST(MultipathTest, ASurfaceEchoesByAMirrorOnlyOnItsOwnSide) {
    const SonarConfig config = lowFan(1);
    // Edge-on to neither: one side of the surface faces the sonar, the other the mirror.
    const auto plate = test::quad({9.4f, 1.64f, -0.3f}, {0.2f, 0.02f, 0}, {0, 0, 0.6f});
    const auto snapshot = test::makeSnapshot(sceneWith({{wallToPort(), makeMirror(1)}, {plate, lambertian()}}));
    const auto ghosts = makePing(bouncing(config), snapshot), plain = makePing(config, snapshot);
    const double r1 = std::hypot(9.5, 1.65), r2 = std::hypot(9.5, 6.35);
    const auto more = [&](double range) {
        return between(ghosts, range - 0.1, range + 0.1) - between(plain, range - 0.1, range + 0.1);
    };
    EXPECT_EQ(more((r1 + r2) / 2), 0);
    EXPECT_GT(more(r2), 0);
}

/** A corner of plates far away, which echo only by their lobes; wavelength 3 mm. */
SonarConfig cornerSonar() {
    SonarConfig config;
    config.speed_of_sound = 1500;
    config.frequency_khz = 500;
    config.range = 60;
    config.bin_count = 400;
    config.beam_count = 1;
    config.field_of_view_deg = 0.4;
    config.beam_height_deg = 0.4;
    config.quality.rows = config.quality.columns_per_beam = 256;
    return config;
}
constexpr double corner_range = 50, corner_wavelength = 0.003;

double computeStrength(const SonarConfig& config, types::GeometryPtr corner) {
    const auto ping = makePing(config, test::makeSnapshot(std::move(corner)));
    double sum = 0;
    for (const float bin : ping.bins) sum += double{bin};
    return decibels(sum * std::pow(corner_range, 4));
}

/** Axes of a corner that looks back at the sonar, turned by two angles [deg]. */
glm::dmat3 cornerAxes(const glm::dmat3& facing, double yaw_deg, double pitch_deg) {
    const glm::dquat turn =
        glm::angleAxis(radians(yaw_deg), glm::dvec3(0, 0, 1)) * glm::angleAxis(radians(pitch_deg), glm::dvec3(0, 1, 0));
    return glm::mat3_cast(turn) * facing;
}

types::GeometryPtr dihedral(double a, double b, double yaw_deg) {
    const double h = std::numbers::sqrt2 / 2;
    const glm::dmat3 axes = cornerAxes({{-h, h, 0}, {-h, -h, 0}, {0, 0, 1}}, yaw_deg, 0);
    const glm::vec3 edge(corner_range, 0, -b / 2), up(0, 0, b);
    return sceneWith(
        {{test::quad(edge, a * axes[0], up), smoothPlate()}, {test::quad(edge, a * axes[1], up), smoothPlate()}});
}

TEST(MultipathTest, ADihedralHasItsTargetStrengthOverFortyDegrees) {
    const double a = 0.1, b = 0.08;
    const SonarConfig config = bouncing(cornerSonar(), 2);
    for (const double yaw : {-20.0, -10.0, 0.0, 7.0, 20.0}) {
        const double aperture = 2 * a * b * std::sin(radians(45 - std::abs(yaw)));
        EXPECT_NEAR(computeStrength(config, dihedral(a, b, yaw)), 20 * std::log10(aperture / corner_wavelength), 1)
            << yaw;
    }
    EXPECT_NEAR(20 * std::log10(2 * a * b * std::sin(radians(45)) / corner_wavelength),
                20 * std::log10(std::numbers::sqrt2 * a * b / corner_wavelength), 1e-9);
    // Without a mirror there is no second bounce; only the sidelobes of both plates remain (ACOUSTICS.md 3.6).
    const double beta = 2 * pi / corner_wavelength * a * std::sin(radians(45)),
                 plate = a * b / corner_wavelength * std::cos(radians(45));
    EXPECT_NEAR(computeStrength(bouncing(cornerSonar(), 1), dihedral(a, b, 0)),
                10 * std::log10(2 * plate * plate / (2 * beta * beta)), 0.5);
}

types::GeometryPtr trihedral(double side, bool square, double yaw_deg, double pitch_deg) {
    // Three perpendicular axes at equal angles to the sonar.
    const double x = std::sqrt(1.0 / 3), r = std::sqrt(2.0 / 3);
    glm::dmat3 facing;
    for (int k = 0; k < 3; ++k) {
        const double turn = 2 * pi / 3 * k;
        facing[k] = {-x, r * std::sin(turn), r * std::cos(turn)};
    }
    const glm::dmat3 axes = cornerAxes(facing, yaw_deg, pitch_deg);
    const glm::vec3 corner(corner_range, 0, 0);
    std::vector<Thing> plates;
    for (int k = 0; k < 3; ++k) {
        const glm::vec3 u(side * axes[k]), v(side * axes[(k + 1) % 3]);
        plates.push_back(
            {square ? test::quad(corner, u, v) : test::getMesh({corner, corner + u, corner + v}, {0, 1, 2}),
             smoothPlate()});
    }
    return sceneWith(std::move(plates));
}

/** Aperture of a trihedral of unit side towards the sonar (the standard forms, by its direction's cosines). */
double trihedralAperture(bool square, double yaw_deg, double pitch_deg) {
    const double x = std::sqrt(1.0 / 3), r = std::sqrt(2.0 / 3);
    const glm::dmat3 turn = cornerAxes(glm::dmat3(1), yaw_deg, pitch_deg);
    std::array<double, 3> c;
    for (int k = 0; k < 3; ++k)
        c[static_cast<size_t>(k)] =
            -(turn * glm::dvec3(-x, r * std::sin(2 * pi / 3 * k), r * std::cos(2 * pi / 3 * k))).x;
    std::ranges::sort(c);
    const auto [l, m, n] = c;
    const double sum = l + m + n;
    if (square) return m <= n / 2 ? 4 * l * m / n : l * (4 - n / m);
    return l + m <= n ? 4 * l * m / sum : sum - 2 / sum;
}

TEST(MultipathTest, ATrihedralHasItsTargetStrengthOverFortyDegrees) {
    EXPECT_NEAR(std::pow(trihedralAperture(false, 0, 0), 2), 1.0 / 3, 1e-9);
    EXPECT_NEAR(std::pow(trihedralAperture(true, 0, 0), 2), 3, 1e-9);
    const double side = 0.1;
    const SonarConfig config = bouncing(cornerSonar(), 2);
    for (const bool square : {false, true})
        for (const auto& [yaw, pitch] :
             {std::pair{0.0, 0.0}, {20.0, 0.0}, {-20.0, 0.0}, {0.0, 20.0}, {0.0, -20.0}, {10.0, 5.0}}) {
            const double aperture = side * side * trihedralAperture(square, yaw, pitch);
            EXPECT_NEAR(computeStrength(config, trihedral(side, square, yaw, pitch)),
                        20 * std::log10(aperture / corner_wavelength), 2)
                << (square ? "square " : "triangular ") << yaw << ' ' << pitch;
        }
}

TEST(MultipathTest, AConcaveCornerShowsItsSecondAndThirdReturn) {
    // A smooth wall and a small plate of Lambert's law that is visible directly and by the wall.
    const auto plate = test::quad({12, -0.3f, -0.3f}, {0, 0.6f, 0}, {0, 0, 0.6f});
    const auto snapshot =
        test::makeSnapshot(sceneWith({{wallToPort(), smoothPlate(0.9f, 0.05f)}, {plate, lambertian()}}));
    const SonarConfig config = lowFan(1);
    const auto one = makePing(bouncing(config, 1), snapshot), two = makePing(bouncing(config, 2), snapshot);
    const double r2 = std::hypot(12, 8), second = (12 + r2) / 2;
    EXPECT_EQ(one.bins, makePing(config, snapshot).bins);
    for (const double range : {second, r2}) {
        const double ghost = between(two, range - 0.5, range + 0.5) - between(one, range - 0.5, range + 0.5);
        EXPECT_GT(ghost,
                  10 * std::abs(between(two, range + 0.5, range + 0.8) - between(one, range + 0.5, range + 0.8)));
        EXPECT_GT(ghost,
                  10 * std::abs(between(two, range - 0.8, range - 0.5) - between(one, range - 0.8, range - 0.5)));
    }
    EXPECT_EQ(makePing(bouncing(config, 2),
                       test::makeSnapshot(sceneWith({{wallToPort(), smoothPlate(0.9f, 0.4f)}, {plate, lambertian()}})))
                  .bins,
              makePing(config,
                       test::makeSnapshot(sceneWith({{wallToPort(), smoothPlate(0.9f, 0.4f)}, {plate, lambertian()}})))
                  .bins)
        << "a slope of 0.4 is no mirror";
}

TEST(MultipathTest, WindTiltsTheSurfaceByItsSlopeAndKeepsTheEnergy) {
    EXPECT_EQ(slopeOfSea(0), 0);
    EXPECT_DOUBLE_EQ(slopeOfSea(0.5), 0.0034);
    EXPECT_NEAR(slopeOfSea(1), 0.0034, 2e-5);
    EXPECT_DOUBLE_EQ(slopeOfSea(3), 4.6e-3 * std::log(2.1 * 9));
    EXPECT_EQ(coherentReflection(0, 0.003, 1), 1);
    const double roughness = 2 * (2 * pi / 0.5) * 0.0053 * 9 * 0.3;
    EXPECT_DOUBLE_EQ(coherentReflection(3, 0.5, 0.3), std::exp(-roughness * roughness / 2));
    const SonarConfig config = surfaceSonar(40, 8);
    auto snapshot = under(2, test::makeScene({test::ground(-4)}));
    const auto plain = makePing(config, snapshot), flat = makePing(mirrored(config), snapshot);
    SonarRenderer rough(mirrored(config, 3), snapshot.geometry);
    types::Sonar first, again, next;
    rough.render(snapshot, first);
    rough.render(snapshot, again);
    EXPECT_EQ(first.bins, again.bins) << "the same ping again";
    snapshot.time.microseconds += 100'000;
    rough.render(snapshot, next);
    EXPECT_NE(first.bins, next.bins) << "another ping, other facets";
    double flat_sum = 0, rough_sum = 0;
    for (const double energy : difference(flat, plain)) flat_sum += energy;
    for (const double energy : difference(next, plain)) rough_sum += energy;
    EXPECT_NEAR(decibels(rough_sum / flat_sum), 0, 1.5);
}

TEST(MultipathTest, TheTruthNamesThePathOfMostOfABinsEnergy) {
    const SonarConfig config = surfaceSonar(8, 4);
    const auto snapshot = under(2, test::makeScene({test::quad({10, -2, -3}, {0, 4, 0}, {0, 0, 2})}));
    SonarRenderer renderer(mirrored(config), snapshot.geometry);
    types::Sonar ping;
    types::SonarTruth truth;
    renderer.setTruth(ping, &truth);
    renderer.render(snapshot, ping);
    const double r1 = std::hypot(10, 2), r2 = std::hypot(10, 6);
    const auto path = [&](double range) {
        return static_cast<int>(truth.path[300 + static_cast<size_t>(range / 0.1)]);
    };
    EXPECT_EQ(path(r1), 0);
    EXPECT_EQ(path((r1 + r2) / 2), 1);
    EXPECT_EQ(path(r2), 2);
    for (const auto& [range, received_from] : {std::pair((r1 + r2) / 2, 0.0), {r2, std::asin(6 / r2)}}) {
        const size_t at = 300 + static_cast<size_t>(range / 0.1);
        EXPECT_EQ(truth.object[at], 0) << "a ghost is of the object seen in the mirror";
        EXPECT_FLOAT_EQ(truth.share[at], 1);
        EXPECT_NEAR(truth.elevation[at], received_from > 0 ? received_from : truth.elevation[at], 0.1);
    }
    types::SonarReturns returns;
    returns.take(ping, truth, std::vector<uint32_t>(ping.beam_count, ping.bin_count));
    EXPECT_NEAR(returns.first_range[1], r1, 0.5) << "ghosts are no first returns";
    for (size_t k = 0; k < ping.bins.size(); ++k) {
        EXPECT_EQ(ping.bins[k] > 0, truth.object[k] >= 0) << k;
        EXPECT_EQ(ping.bins[k] > 0, truth.path[k] > 0 || truth.hits[k] > 0) << k;
        EXPECT_FALSE(ping.bins[k] > 0 && truth.shadow[k]) << k;
    }
    auto wall = test::makeSnapshot(sceneWith(
        {{wallToPort(), makeMirror(1)}, {test::quad({12, -0.3f, -0.3f}, {0, 0.6f, 0}, {0, 0, 0.6f}), lambertian()}}));
    SonarRenderer bounced(bouncing(lowFan(1)), wall.geometry);
    bounced.setTruth(ping, &truth);
    bounced.render(wall, ping);
    EXPECT_EQ(static_cast<int>(truth.path[static_cast<size_t>(std::hypot(12, 8) / 0.1)]), 3);
    EXPECT_EQ(truth.object[static_cast<size_t>(std::hypot(12, 8) / 0.1)], 1) << "the plate, not the wall";
}

TEST(MultipathTest, DoesNotDependOnTheNumberOfThreads) {
    const auto snapshot = under(2, test::makeScene({test::ground(-4), test::sphere(1, 24)}, 0, {{}, {9, 1, -1}}));
    const auto bins = [&](int threads) {
        RenderOptions options;
        options.threads = threads;
        SonarRenderer renderer(mirrored(surfaceSonar(90, 16), 3), snapshot.geometry, options);
        types::Sonar ping;
        renderer.render(snapshot, ping);
        return ping.bins;
    };
    EXPECT_EQ(bins(1), bins(2));
    EXPECT_EQ(bins(1), bins(5));
}

TEST(MultipathTest, GhostsAreAtTheirPlacesWithAPatternConesAndAMovingObject) {
    for (const BeamGeometry geometry : {BeamGeometry::Planar, BeamGeometry::Conical}) {
        SonarConfig config = mirrored(surfaceSonar(60, 30));
        config.beam_geometry = geometry;
        acoustics::BeamLaw law;
        law.width_deg = 3;
        config.beam_pattern.emplace().receive.azimuth = law;
        auto snapshot = under(3, test::makeScene({test::sphere(0.3, 24)}, 0, {{12, 0, -1}}));
        glm::dmat4 moved(1);
        moved[3] = {12, 3, -1, 1};
        snapshot.moved = {{0, moved}};
        const auto ghosts = makePing(config, snapshot);
        const double r1 = glm::length(glm::dvec3(12, 3, -1)), r2 = glm::length(glm::dvec3(12, 3, 7));
        size_t loudest = 0;
        for (size_t beam = 0; beam < 30; ++beam)
            if (between(ghosts, (r1 + r2) / 2 - 0.4, (r1 + r2) / 2 + 0.4, beam) >
                between(ghosts, (r1 + r2) / 2 - 0.4, (r1 + r2) / 2 + 0.4, loudest))
                loudest = beam;
        EXPECT_NEAR(types::degrees(ghosts.bearings[loudest].rad), types::degrees(std::atan2(3, 12)), 2.1);
        EXPECT_GT(between(ghosts, r2 - 0.5, r2 + 0.3, loudest), 0);
    }
}

}  // namespace
}  // namespace insonify::sonar
