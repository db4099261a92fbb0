// Bodies with a fluid behind their wall: times, refraction, spreading and loss, compared with the geometry of rays
// (ACOUSTICS.md 5.26).
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <iostream>
#include <numbers>
#include <random>

#include "components/acoustics/Plate.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "tests/sonar/ShellScenes.hpp"
#include "tests/support/Pings.hpp"

namespace insonify::sonar {
namespace {

using std::numbers::pi;
using test::makePing;
using test::makeSnapshot;

/** A very thin film with a fluid behind it. */
types::Shell filled(double density, double speed, double loss = 0) {
    return {.thickness = 1e-5,
            .density = 1000,
            .sound_speed = 1000,
            .shear_speed = 0,
            .loss = 0,
            .has_air = false,
            .fill_density = density,
            .fill_speed = speed,
            .fill_loss = loss};
}
acoustics::PlateResponse filmResponse(const types::Shell& shell, double cosine) {
    return shellResponse(shell, cosine, {shell.fill_density, shell.fill_speed});
}
/** Returns the share of the energy that passes into a fluid and back out at a cosine in the water. */
double sharePassed(const types::Shell& shell, double cosine) {
    const double sine = std::sqrt(1 - cosine * cosine) * shell.fill_speed / water_speed;
    if (sine >= 1) return 0;
    const double fluids =
        1025 * water_speed / cosine / (shell.fill_density * shell.fill_speed / std::sqrt(1 - sine * sine));
    return std::pow(std::norm(filmResponse(shell, cosine).transmitted) * fluids, 2);
}

/** A ray from the origin through one surface of a body to the next, of any shape. */
struct Shape {
    std::function<double(const glm::dvec3& from, const glm::dvec3& way)> distance;
    std::function<glm::dvec3(const glm::dvec3& at)> outward;
};
struct Met {
    glm::dvec3 at, way;
    double range, near_cosine, cosine;  ///< Slant range of the second surface, cosines at the two.
};
Met rayThrough(const Shape& near, const Shape& far, const glm::dvec3& look, double speed) {
    Met met;
    const double first = near.distance(glm::dvec3(0), look);
    const glm::dvec3 entry = first * look, normal = near.outward(entry);
    met.near_cosine = -glm::dot(normal, look);
    const double cosine = std::sqrt(1 - speed * speed * (1 - met.near_cosine * met.near_cosine));
    met.way = speed * look + (speed * met.near_cosine - cosine) * normal;
    const double second = far.distance(entry, met.way);
    met.at = entry + second * met.way;
    met.range = first + second / speed;
    met.cosine = std::abs(glm::dot(far.outward(met.at), met.way));
    return met;
}
/** Returns the energy per steradian from the far surface, relative to a plane of unit strength a metre away: by the
 *  spreading of a bundle of rays on the way out and on the way back. */
double computeLevel(const Shape& near, const Shape& far, const glm::dvec3& look, double speed) {
    const Met met = rayThrough(near, far, look, speed);
    const glm::dvec3 up = glm::normalize(glm::cross(look, glm::dvec3(0, 1, 0.1))), across = glm::cross(look, up);
    constexpr double step = 1e-5;
    const auto change = [&](const glm::dvec3& aside) {
        return (rayThrough(near, far, glm::normalize(look + step * aside), speed).at -
                rayThrough(near, far, glm::normalize(look - step * aside), speed).at) /
               (2 * step);
    };
    const double area = std::abs(glm::dot(glm::cross(change(up), change(across)), met.way));
    return met.cosine * speed * speed / area;  // Lambert's law over the cosine, and the n^2 law of radiance
}

/** An interface and a plate behind it, at the angles of transmission. */
TEST(FilledBodyTest, APlateBehindAnInterfaceIsAtItsTimeAndLevelOverAngles) {
    double worst_range = 0, worst_level = 0;
    for (const auto& [density, speed] : {std::pair(825., 800.), {1900., 1300.}, {1025., 1000.}}) {
        const types::Shell shell = filled(density, speed);
        const SonarConfig config = wallSonar(60, 0.5, 64);
        const auto both = makePing(config, makeSnapshot(makeShells({test::wall(6), test::wall(11)}, 1, shell)));
        const auto alone = makePing(config, makeSnapshot(makeShells({test::wall(11)}, 0)));
        const auto plate = [](double x) {
            return Shape{[=](const glm::dvec3& from, const glm::dvec3& way) { return (x - from.x) / way.x; },
                         [](const glm::dvec3&) { return glm::dvec3(-1, 0, 0); }};
        };
        for (uint32_t beam = 0; beam < 64; ++beam) {
            const double bearing = both.bearings[beam].rad;
            const glm::dvec3 look(std::cos(bearing), std::sin(bearing), 1e-9);
            const Met met = rayThrough(plate(6), plate(11), look, speed / water_speed);
            double sum = 0, moment = 0;
            for (uint32_t k = 0; k < both.bin_count; ++k) {
                const double at = both.binStart(k + 0.5),
                             bin = static_cast<double>(both.bins[beam * both.bin_count + k]);
                if (std::abs(at - met.range) > 0.6) continue;
                sum += bin, moment += bin * at;
            }
            const double expected =
                computeLevel(plate(6), plate(11), look, speed / water_speed) * sharePassed(shell, std::cos(bearing));
            const double range = 11 / std::cos(bearing);
            const double unit = sumEnergy(alone, beam, 0, 30) / (std::cos(bearing) / (range * range));
            worst_range = std::max(worst_range, std::abs(moment / sum - met.range));
            worst_level = std::max(worst_level, std::abs(10 * std::log10(sum / (unit * expected))));
        }
    }
    std::cout << "a plate behind an interface up to 30 deg off its normal: ranges at most " << worst_range
              << " m off (bins of 0.1 m), levels " << worst_level << " dB\n";
    EXPECT_LT(worst_range, 0.06);
    EXPECT_LT(worst_level, 0.1);
}

/** At normal incidence the return path spreads by the reciprocal geometry: s^2 / (h_1 + s h_2)^2. */
TEST(FilledBodyTest, SpreadingAtTheNormalIsThatOfTextbooks) {
    const double speed = 1.4;
    const types::Shell shell = filled(1200, speed * water_speed);
    const SonarConfig config = wallSonar(0.5, 0.5, 1);
    const auto both = makePing(config, makeSnapshot(makeShells({test::wall(4), test::wall(9)}, 1, shell)));
    const auto alone = makePing(config, makeSnapshot(makeShells({test::wall(9)}, 0)));
    const double expected = std::pow(speed / (4 + speed * 5), 2) * 81 * sharePassed(shell, 1);
    EXPECT_NEAR(sumEnergy(both, 0, 7, 8) / test::computeSum(alone) / expected, 1, 0.01);
}

/** The far side of a body from within, bin by bin, integrated over the directions of its outline. */
std::vector<double> farSideBins(const Shape& near, const Shape& far, const types::Shell& shell,
                                const types::Sonar& ping, double azimuth, double elevation, int steps) {
    std::vector<double> bins(ping.bin_count, 0);
    const double strength = 0.1 * std::norm(filmResponse(shell, 1).reflected);
    const int up = std::max(1, static_cast<int>(steps * elevation / azimuth));
    const double solid = 4 * azimuth * elevation / (static_cast<double>(steps) * up);
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < up; ++j) {
            const double a = azimuth * ((i + 0.5) / steps * 2 - 1), e = elevation * ((j + 0.5) / up * 2 - 1);
            const glm::dvec3 look(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
            const double first = near.distance(glm::dvec3(0), look);
            if (!(first > 0)) continue;
            const Met met = rayThrough(near, far, look, shell.fill_speed / water_speed);
            if (!(met.near_cosine > 0.2)) continue;
            const double level = strength * computeLevel(near, far, look, shell.fill_speed / water_speed) *
                                 sharePassed(shell, met.near_cosine) * solid * std::cos(e);
            const auto bin = static_cast<size_t>(met.range / ping.binStart(1));
            if (bin < bins.size()) bins[bin] += level;
        }
    return bins;
}

Shape roundBody(double distance, double radius, bool is_far, bool is_cylinder) {
    const auto off = [=](const glm::dvec3& at) { return glm::dvec3(at.x - distance, at.y, is_cylinder ? 0 : at.z); };
    return {[=](const glm::dvec3& from, const glm::dvec3& way) {
                const glm::dvec3 to = off(from), along(way.x, way.y, is_cylinder ? 0 : way.z);
                const double a = glm::dot(along, along), b = glm::dot(to, along),
                             c = glm::dot(to, to) - radius * radius;
                const double root = b * b - a * c;
                return root > 0 ? (-b + (is_far ? 1 : -1) * std::sqrt(root)) / a : -1;
            },
            [=](const glm::dvec3& at) { return glm::normalize(off(at)); }};
}

types::Mesh closedCylinder(double radius, uint32_t around, float half_length) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    for (uint32_t j = 0; j < around; ++j) {
        const double angle = 2 * pi * j / around;
        for (const float up : {-half_length, half_length})
            positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), up);
        const uint32_t a = 2 * j, b = 2 * ((j + 1) % around);
        indices.insert(indices.end(), {a, b, a + 1, b, b + 1, a + 1});
    }
    const auto middle = static_cast<uint32_t>(positions.size());
    positions.emplace_back(0, 0, -half_length);
    positions.emplace_back(0, 0, half_length);
    for (uint32_t j = 0; j < around; ++j) {
        const uint32_t a = 2 * j, b = 2 * ((j + 1) % around);
        indices.insert(indices.end(), {middle, b, a, middle + 1, a + 1, b + 1});
    }
    return test::getMesh(positions, indices);
}

void expectFarSide(const types::Mesh& mesh, bool is_cylinder, double distance, double radius) {
    for (const auto& [density, speed] : {std::pair(1900., 1250.), {825., 960.}}) {
        const types::Shell shell = filled(density, speed);
        const double wide = is_cylinder ? 3 : 7, high = is_cylinder ? 0.5 : 7;
        SonarConfig config = wallSonar(2 * wide, 2 * high, 1, 600);
        config.range = 60;
        config.quality.rows = is_cylinder ? 64 : 512;
        config.quality.columns_per_beam = 512;
        const auto ping = makePing(config, makeSnapshot(makeShells({mesh}, 1, shell, {{distance, 0, 0}})));
        const std::vector<double> expected =
            farSideBins(roundBody(distance, radius, false, is_cylinder), roundBody(distance, radius, true, is_cylinder),
                        shell, ping, wide * pi / 180, high * pi / 180, 600);
        const double last = distance - radius + 2 * radius * water_speed / speed;
        double sum = 0, wanted = 0, moment = 0, wanted_moment = 0;
        for (uint32_t k = 0; k < ping.bin_count; ++k) {
            const double at = ping.binStart(k + 0.5);
            if (at < last - 0.3 * radius || at > last + 0.3) continue;
            sum += static_cast<double>(ping.bins[k]), moment += at * static_cast<double>(ping.bins[k]);
            wanted += expected[k], wanted_moment += at * expected[k];
        }
        std::cout << (is_cylinder ? "cylinder" : "sphere") << " filled at " << speed << " m/s: far side "
                  << 10 * std::log10(sum / wanted) << " dB off, " << moment / sum - wanted_moment / wanted
                  << " m off; last bin " << last << " m\n";
        EXPECT_NEAR(10 * std::log10(sum / wanted), 0, 0.5) << speed;
        EXPECT_NEAR(moment / sum, wanted_moment / wanted, 0.05) << speed;
    }
}

TEST(FilledBodyTest, TheFarSideOfAFilledSphereMatchesRays) { expectFarSide(test::sphere(3, 256), false, 20, 3); }

TEST(FilledBodyTest, TheFarSideOfAFilledCylinderMatchesRays) { expectFarSide(closedCylinder(2, 1440, 3), true, 20, 2); }

/** A sphere of another fluid is a thick lens for objects behind it, and sound passes in and out through its wall twice:
 *  paraxial optics, Born and Wolf 1999, 4.4. */
TEST(FilledBodyTest, AFilledSphereIsALensForObjectsBehindIt) {
    constexpr double radius = 3, centre = 20, wall = 30;
    const SonarConfig config = wallSonar(0.2, 0.2, 1, 600);
    const auto alone = makePing(config, makeSnapshot(makeShells({test::wall(wall)}, 0)));
    for (const auto& [density, speed] : {std::pair(1900., 1250.), {825., 960.}, {1100., 920.}}) {
        const double n = water_speed / speed;
        double height = centre - radius, angle = 1;  // of a ray that leaves the sonar at a small angle, over that
        angle = angle / n - height * (n - 1) / (radius * n);
        height += 2 * radius * angle;
        angle = n * angle + height * (1 - n) / radius;
        height += (wall - centre - radius) * angle;
        const types::Shell shell = filled(density, speed);
        const auto ping = makePing(config, makeSnapshot(makeShells({test::sphere(radius, 200), test::wall(wall)}, 1,
                                                                   shell, {{centre, 0, 0}, {0, 0, 0}})));
        const double range = wall + 2 * radius * (n - 1);
        const double level =
            sumEnergy(ping, 0, range - 0.3, range + 0.3) * range * range / (test::computeSum(alone) * wall * wall);
        const double expected = std::pow(range / height * sharePassed(shell, 1), 2);
        std::cout << "lens of " << speed << " m/s: " << 10 * std::log10(level / expected) << " dB off "
                  << 10 * std::log10(expected) << " dB\n";
        EXPECT_NEAR(10 * std::log10(level / expected), 0, 0.3) << speed;
    }
}

TEST(FilledBodyTest, LossIsThatOfThePathInTheFill) {
    const SonarConfig config = wallSonar(0.5, 0.5, 1);
    const types::Shell clear = filled(1200, 1250), lossy = filled(1200, 1250, 1e-4);
    const auto scene = [](const types::Shell& shell) { return makeShells({test::wall(4), test::wall(9)}, 1, shell); };
    const double ratio = sumEnergy(makePing(config, makeSnapshot(scene(lossy))), 0, 7.5, 8.5) /
                         sumEnergy(makePing(config, makeSnapshot(scene(clear))), 0, 7.5, 8.5);
    EXPECT_NEAR(std::log(ratio), -4 * 5 * 2 * pi * 1000 * shell_khz / 1250 * 1e-4, 0.01);
}

/** The water's absorption is that of the path in the water. */
TEST(FilledBodyTest, TheFillDoesNotAbsorbAsWaterDoes) {
    SonarConfig config = wallSonar(0.5, 0.5, 1);
    const types::Shell shell = filled(1200, 1250);
    const auto scene = makeShells({test::wall(4), test::wall(9)}, 1, shell);
    const double without = sumEnergy(makePing(config, makeSnapshot(scene)), 0, 7.5, 8.5);
    config.absorption.emplace().db_per_m = 1;
    const double with = sumEnergy(makePing(config, makeSnapshot(scene)), 0, 7.5, 8.5);
    EXPECT_NEAR(10 * std::log10(with / without), -2 * 4, 0.15) << "bins have the absorption of their middle";
}

TEST(FilledBodyTest, NothingPassesIntoAirNorBeyondTheCriticalAngle) {
    types::Shell air = filled(1.2, 340);
    air.has_air = true;
    air.fill_density = 0;
    const SonarConfig config = wallSonar(100, 0.5, 64);
    const auto behind = makePing(config, makeSnapshot(makeShells({test::wall(6), test::wall(11)}, 1, air)));
    const auto alone = makePing(config, makeSnapshot(makeShells({test::wall(6)}, 1, air)));
    EXPECT_EQ(behind.bins, alone.bins);
    const types::Shell fast = filled(1100, 1500);  // critical at 41.8 deg
    const auto both = makePing(config, makeSnapshot(makeShells({test::wall(6), test::wall(11)}, 1, fast)));
    const auto one = makePing(config, makeSnapshot(makeShells({test::wall(6)}, 1, fast)));
    for (uint32_t beam = 0; beam < 64; ++beam) {
        const double bearing = std::abs(both.bearings[beam].rad);
        if (std::abs(bearing - 0.73) < 0.03) continue;
        const bool differs = !std::equal(both.bins.begin() + beam * 300, both.bins.begin() + (beam + 1) * 300,
                                         one.bins.begin() + beam * 300);
        EXPECT_EQ(differs, bearing < 0.73) << bearing;
    }
}

/** A fill with the numbers of water is no fill except for rounding. */
TEST(FilledBodyTest, AFillOfWaterIsWater) {
    const SonarConfig config = wallSonar(8, 8, 4);
    types::Shell by_numbers = acrylic;
    by_numbers.fill_density = 1025, by_numbers.fill_speed = water_speed;
    const auto one = makePing(config, makeSnapshot(makeShells({test::sphere(1, 128)}, 1, acrylic, {{8, 0, 0}})));
    const auto other = makePing(config, makeSnapshot(makeShells({test::sphere(1, 128)}, 1, by_numbers, {{8, 0, 0}})));
    EXPECT_NEAR(test::computeSum(one) / test::computeSum(other), 1, 1e-3);
    for (size_t i = 0; i < one.bins.size(); ++i)
        EXPECT_NEAR(one.bins[i], other.bins[i], 2e-2 * test::computeSum(one)) << i;
}

TEST(FilledBodyTest, CoherentSpeckleAndPatternsKeepTheEnergyOfTheFarSide) {
    const types::Shell shell = filled(1200, 1250);
    for (const std::string effect : {"pattern", "pulse", "coherent"}) {
        SonarConfig config = wallSonar(16, 4, 32);
        if (effect == "pattern") config.beam_pattern.emplace().receive.azimuth.emplace().width_deg = 1.5;
        if (effect == "pulse") config.pulse.emplace().bandwidth_khz = 2;
        if (effect == "coherent") config.speckle.emplace().coherent = true;
        double far = 0, alone = 0;
        for (int place = 0; place < (effect == "coherent" ? 20 : 1); ++place) {  // of other scatterers
            const glm::dvec3 position(0, 3 * place - 30, 0);
            const auto ping =
                makePing(config, makeSnapshot(makeShells({test::wall(6), test::wall(11)}, 1, shell), position));
            const auto plain = makePing(config, makeSnapshot(makeShells({test::wall(11)}, 0), position));
            for (uint32_t beam = 4; beam < 28; ++beam) {
                far += sumEnergy(ping, beam, 9.4, 12);
                alone += sumEnergy(plain, beam, 10, 13);
            }
        }
        const double speed = 1.25, expected = std::pow(speed * 11 / (6 + speed * 5), 2) * sharePassed(shell, 1);
        std::cout << effect << ": far side " << far / alone / expected - 1 << " off\n";
        EXPECT_NEAR(far / alone / expected, 1, effect == "coherent" ? 0.1 : 0.03) << effect;
    }
}

TEST(FilledBodyTest, RandomBodiesAreFinite) {
    std::mt19937 random(11);
    const auto between = [&](double low, double high) {
        return std::exp(std::uniform_real_distribution(std::log(low), std::log(high))(random));
    };
    for (int i = 0; i < 60; ++i) {
        types::Shell shell = filled(between(10, 20000), between(200, 6000), i % 3 ? between(1e-6, 1) : 0);
        shell.thickness = i % 5 == 4 ? 0 : between(1e-4, 1);
        shell.density = between(500, 9000);
        shell.sound_speed = i % 7 == 0 ? water_speed : between(300, 7000);
        shell.shear_speed = i % 2 ? 0.4 * shell.sound_speed : 0;
        SonarConfig config = wallSonar(between(1, 120), between(1, 60), 1 + i % 9, 200);
        config.frequency_khz = between(10, 3000);
        config.quality.rows = 32;
        config.quality.columns_per_beam = 4;
        if (i % 4 == 0) config.speckle.emplace().coherent = true;
        if (i % 6 == 1) config.beam_geometry = BeamGeometry::Conical;
        const auto scene = makeShells({test::sphere(2, 24), test::sphere(0.7, 16), test::wall(9)}, 2 + i % 2, shell,
                                      {{6, 0.3, 0}, {6, 0, 0.2}, {0, 0, 0}});
        const auto ping = makePing(config, makeSnapshot(scene, {}, between(0.01, 0.5), -between(0.01, 0.5)));
        for (const float bin : ping.bins) ASSERT_TRUE(std::isfinite(bin) && bin >= 0) << i;
    }
}

}  // namespace
}  // namespace insonify::sonar
