// Pings of scenes whose echo is known in closed form (physics.md 3.5), drawn through OpenGL. Every form stands beside
// a deliberately wrong one, which must fail by the same measure.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "components/sonar/BinGrid.hpp"
#include "components/sonar/SonarRenderer.hpp"
#include "tests/support/Scenes.hpp"
#include "types/Angle.hpp"

namespace insonify::sonar {
namespace {

using std::numbers::pi;
using types::radians;

/** Energy between slant ranges [r1, r2] in one beam, or the mean of S there. */
using Form = std::function<double(double r1, double r2)>;

/** Bins of whole microseconds at 1000 m/s: 0.1 m is 100 us. */
SonarConfig sonarOf(double fov_deg, double height_deg, int beams, double bin, int bins) {
    SonarConfig config;
    config.speed_of_sound = 1000;
    config.range = bin * bins;
    config.bin_count = bins;
    config.beam_count = beams;
    config.field_of_view_deg = fov_deg;
    config.beam_height_deg = height_deg;
    config.quality.rows = 512;
    config.quality.columns_per_beam = std::max(2, 512 / beams);
    return config;
}

types::Sonar pingOf(const SonarConfig& config, const types::Snapshot& snapshot) {
    SonarRenderer renderer(config, snapshot.geometry);
    types::Sonar ping;
    renderer.render(snapshot, ping);
    return ping;
}

/** How far a ping is from a form: relative L2, worst bin above -40 dB of the form's maximum, rms over beams of the energy ratio. */
struct Deviation {
    double relative_l2, worst_db, ripple;
    bool small() const { return relative_l2 < 0.01 && worst_db < 0.2 && ripple < 0.01; }
};

Deviation deviation(const types::Sonar& ping, const Form& form) {
    std::vector<double> expected(ping.bin_count);
    for (uint32_t k = 0; k < ping.bin_count; ++k) expected[k] = form(ping.binStart(k), ping.binStart(k + 1));
    const double floor = *std::max_element(expected.begin(), expected.end()) * 1e-4;
    double error = 0, norm = 0, worst = 0, ripple = 0;
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam) {
        double sum = 0, truth = 0;
        for (uint32_t k = 0; k < ping.bin_count; ++k) {
            const double got = ping.bins[beam * ping.bin_count + k], e = expected[k];
            error += (got - e) * (got - e);
            norm += e * e;
            sum += got;
            truth += e;
            if (e > floor) worst = std::max(worst, got > 0 ? std::abs(10 * std::log10(got / e)) : 999);
        }
        ripple += (sum / truth - 1) * (sum / truth - 1) / ping.beam_count;
    }
    return {std::sqrt(error / norm), worst, std::sqrt(ripple)};
}

std::ostream& operator<<(std::ostream& out, const Deviation& d) {
    return out << "relative L2 " << d.relative_l2 << ", worst " << d.worst_db << " dB, ripple " << d.ripple;
}

void expectForm(const types::Sonar& ping, const Form& right, const Form& wrong) {
    const Deviation d = deviation(ping, right);
    EXPECT_TRUE(d.small()) << d;
    EXPECT_FALSE(deviation(ping, wrong).small()) << "a wrong form passed: " << deviation(ping, wrong);
    testing::Test::RecordProperty("relative_l2", std::to_string(d.relative_l2));
}

double inverseFourth(double r1, double r2) { return 0.25 * (std::pow(r1, -4) - std::pow(r2, -4)); }

types::Mesh disc(double distance, double radius) {
    std::vector<glm::vec3> positions = {{distance, 0, 0}};
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < 256; ++i) {
        const double angle = 2 * pi * i / 256;
        positions.push_back({distance, radius * std::cos(angle), radius * std::sin(angle)});
        indices.insert(indices.end(), {0, 1 + i, 1 + (i + 1) % 256});
    }
    return test::meshOf(positions, indices);
}

types::Mesh wall(double distance) {
    return test::quad({static_cast<float>(distance), -100, -100}, {0, 200, 0}, {0, 0, 200});
}

}  // namespace

TEST(ClosedFormTest, FlatBottomUnderALevelFanIsTheSameInAllBeams) {
    const double height = 5, fov = 130, elevation = radians(20);
    const auto snapshot = test::snapshotOf(test::sceneOf({test::ground(-5)}));
    for (int beams : {64, 256}) {
        const auto form = [&](double cosine_power) {
            return [=](double r1, double r2) {
                const double from = std::max(r1, height / std::sin(elevation)), delta = radians(fov / beams);
                if (r2 <= from) return 0.0;
                return cosine_power == 1 ? height * height * delta * inverseFourth(from, r2)
                                         : height * delta * (std::pow(from, -3) - std::pow(r2, -3)) / 3;  // no cos(theta)
            };
        };
        expectForm(pingOf(sonarOf(fov, 40, beams, 0.1, 500), snapshot), form(1), form(0));
    }
}

TEST(ClosedFormTest, AnyPlaneFacingDiscShowsOmegaOverRToTheFifth) {
    const double distance = 10, edge = 10.4, radius = std::sqrt(edge * edge - distance * distance);
    const auto form = [&](double mu) {
        return [=](double r1, double r2) {
            const double from = std::max(r1, distance), to = std::min(r2, edge);
            return to <= from ? 0.0 : mu * distance * distance * 2 * pi * inverseFourth(from, to);
        };
    };
    const auto snapshot = test::snapshotOf(test::sceneOf({disc(distance, radius)}, -10));
    expectForm(pingOf(sonarOf(40, 40, 1, 0.1, 120), snapshot), form(0.1), form(0.105));
}

TEST(ClosedFormTest, RolledPlaneHasTheSameEnergyPerRangeAsALevelOneInAConeOfAllBearings) {
    // A plane ahead, turned about the line of sight, is the facing disc again: nothing may depend on roll.
    const double distance = 10, edge = 10.4, radius = std::sqrt(edge * edge - distance * distance);
    const auto geometry = test::sceneOf({disc(distance, radius)});
    const auto config = sonarOf(40, 40, 1, 0.1, 120);
    const auto straight = pingOf(config, test::snapshotOf(geometry)), rolled = pingOf(config, test::snapshotOf(geometry, {}, 0, 0, 0.3));
    expectForm(rolled, [&](double r1, double) { return straight.bins[static_cast<size_t>(r1 / 0.1 + 0.5)]; },
               [&](double r1, double) { return straight.bins[static_cast<size_t>(r1 / 0.1 + 0.5)] * 1.02; });
}

TEST(ClosedFormTest, PitchedPlaneFollowsTheThinBeamForm) {
    const double height = 5, pitch = radians(30), up = radians(20), down = radians(20), delta = radians(1);
    const auto f4 = [](double p) { return 3 * p / 8 - std::sin(2 * p) / 4 + std::sin(4 * p) / 32; };
    const auto form = [&](double tilt) {
        return [=](double r1, double r2) {
            const double from = std::max(r1, height / std::sin(pitch + down)), to = std::min(r2, height / std::sin(pitch - up));
            if (to <= from) return 0.0;
            return delta * (std::cos(tilt) * height * height * inverseFourth(from, to) +
                            std::sin(tilt) / (height * height) * (f4(std::asin(height / from)) - f4(std::asin(height / to))));
        };
    };
    const auto snapshot = test::snapshotOf(test::sceneOf({test::ground(-5)}), {}, 0, pitch);
    expectForm(pingOf(sonarOf(1, 40, 1, 0.1, 300), snapshot), form(pitch), form(0));
}

TEST(ClosedFormTest, SphereFollowsItsRangeDensity) {
    const double a = 1, centre = 10, q = centre * centre - a * a;
    const auto form = [&](double factor) {
        return [=](double r1, double r2) {
            const auto integral = [&](double r) { return -q * q / (4 * std::pow(r, 4)) + q / (r * r) + std::log(r); };
            const double from = std::max(r1, centre - a), to = std::min(r2, std::sqrt(q));
            return to <= from ? 0.0 : factor * pi / (2 * a * centre) * (integral(to) - integral(from));
        };
    };
    const auto snapshot = test::snapshotOf(test::sceneOf({test::sphere(1, 256)}, 0, {{10, 0, 0}}));
    // Bins of 0.2 m: at the limb one pixel spans 0.1 m of range, so that narrower bins would test the silhouette.
    expectForm(pingOf(sonarOf(12, 12, 1, 0.2, 60), snapshot), form(1), form(1.03));
}

TEST(ClosedFormTest, WallAheadFollowsTheThinVerticalBeamForm) {
    const double distance = 10, delta = radians(1), edge = distance / std::cos(radians(20));
    const auto g4 = [](double p) { return 3 * p / 8 + std::sin(2 * p) / 4 + std::sin(4 * p) / 32; };
    const auto form = [&](double beta) {
        return [=](double r1, double r2) {
            const double from = std::max(r1, distance), to = std::min(r2, edge);
            if (to <= from) return 0.0;
            return 2 * delta / (distance * distance) * (g4(std::acos(distance / to)) - g4(std::acos(distance / from))) *
                   std::exp(-beta * (from - distance));
        };
    };
    expectForm(pingOf(sonarOf(1, 40, 1, 0.1, 150), test::snapshotOf(test::sceneOf({wall(distance)}))), form(0), form(0.2));
}

TEST(ClosedFormTest, TwoObjectsAtOneRangeDoubleTheEnergyButNotThePublishedMean) {
    const types::Mesh plate = test::sphere(0.3f, 64);
    const double up = radians(6);
    const glm::dvec3 high(10 * std::cos(up), 0, 10 * std::sin(up)), low(10 * std::cos(up), 0, -10 * std::sin(up));
    const auto one = test::snapshotOf(test::sceneOf({plate}, 0, {high})), two = test::snapshotOf(test::sceneOf({plate, plate}, 0, {high, low}));
    auto config = sonarOf(10, 20, 1, 0.1, 120);
    const auto single = pingOf(config, one), both = pingOf(config, two);
    expectForm(both, [&](double r1, double) { return 2.0 * single.bins[static_cast<size_t>(r1 / 0.1 + 0.5)]; },
               [&](double r1, double) { return single.bins[static_cast<size_t>(r1 / 0.1 + 0.5)]; });
    config.model = Model::Cerqueira2017;
    const auto published_single = pingOf(config, one), published_both = pingOf(config, two);
    for (size_t k = 0; k < published_both.bins.size(); ++k) EXPECT_NEAR(published_both.bins[k], published_single.bins[k], 1e-3) << k;
}

TEST(ClosedFormTest, ShadowBehindAScreenEndsWhereTheTopRayMeetsTheBottom) {
    // A screen of height h stands on the bottom at horizontal distance R; the sonar is at height H.
    const double height = 5, screen = 2, ground_range = 15;
    const double top = std::hypot(ground_range, height - screen), end = top * height / (height - screen);
    const double foot = std::hypot(ground_range, height);
    const auto geometry = test::sceneOf({test::ground(-5), test::quad({15, -50, -5}, {0, 100, 0}, {0, 0, 2})});
    const auto ping = pingOf(sonarOf(1, 60, 1, 0.1, 400), test::snapshotOf(geometry));
    int last_dark = -1;
    for (int k = static_cast<int>(foot / 0.1) + 2; k < 400 && ping.bins[static_cast<size_t>(k)] == 0; ++k) last_dark = k;
    EXPECT_NEAR((last_dark + 1) * 0.1, end, 0.1) << "shadow [m]";
    EXPECT_GT(std::abs((last_dark + 1) * 0.1 - ground_range * height / (height - screen)), 0.1) << "ground range is the wrong form";
}

TEST(CerqueiraLimitTest, EveryPlaneIsTheSigmoidOfDistanceOverRange) {
    const auto sigmoid = [](double x) { return 0.5 + 0.5 * std::tanh(9 * (x - 2.0 / 3)); };
    auto config = sonarOf(130, 40, 64, 0.1, 300);
    config.model = Model::Cerqueira2017;
    const auto ping = pingOf(config, test::snapshotOf(test::sceneOf({test::ground(-5)}), {}, 0, radians(15)));
    const auto form = [&](double slope) {
        return [=](double r1, double r2) { return r1 < 10 ? 0.0 : sigmoid(slope * 5 / (0.5 * (r1 + r2))); };
    };
    for (uint32_t beam = 16; beam < 48; ++beam)  // beams that see all of 10 to 25 m
        for (uint32_t k = 100; k < 250; ++k) {
            const double got = ping.bins[beam * ping.bin_count + k], right = form(1)(k * 0.1, k * 0.1 + 0.1);
            EXPECT_NEAR(got, right, 0.01 * right + 1e-5) << beam << " " << k;
        }
    EXPECT_GT(std::abs(ping.bins[32 * 300 + 110] - form(1.05)(11, 11.1)), 0.01 * form(1.05)(11, 11.1));
}

TEST(CerqueiraLimitTest, SphereIsTheSigmoidOfItsIncidence) {
    auto config = sonarOf(14, 14, 1, 0.1, 120);
    config.model = Model::Cerqueira2017;
    const auto ping = pingOf(config, test::snapshotOf(test::sceneOf({test::sphere(1, 256)}, 0, {{10, 0, 0}})));
    const auto cosine = [](double r) { return (100 - 1 - r * r) / (2 * r); };
    const auto mean = [&](double r1, double r2, double power) {  // over solid angle, r dr / (a-independent)
        double sum = 0, weight = 0;
        for (int i = 0; i < 1000; ++i) {
            const double r = r1 + (r2 - r1) * (i + 0.5) / 1000, w = (100 - 1 + r * r) == 0 ? 0 : (99 - r * r) / (r * r);
            sum += w * (0.5 + 0.5 * std::tanh(9 * (std::pow(cosine(r), power) - 2.0 / 3)));
            weight += w;
        }
        return sum / weight;
    };
    for (int k = 90; k < 98; ++k) EXPECT_NEAR(ping.bins[static_cast<size_t>(k)], mean(k * 0.1, k * 0.1 + 0.1, 1), 0.01) << k;
    EXPECT_GT(std::abs(ping.bins[92] - mean(9.2, 9.3, 2)), 0.01);
}

}  // namespace insonify::sonar
