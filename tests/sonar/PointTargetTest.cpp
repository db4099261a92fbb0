// Point targets compared with the active sonar equation, computed here from the laws themselves (ACOUSTICS.md 5.14).
#include <gmock/gmock.h>

#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>
#include <span>

#include "components/acoustics/BeamPattern.hpp"
#include "components/acoustics/Pulse.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/sonar/BeamCut.hpp"
#include "tests/support/EveryRenderer.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using acoustics::Weighting;
using std::numbers::pi;
using test::everyRenderer;
using test::getLaw;
using test::makePing;
using test::openWater;
using types::radians;

/** Bins of 0.1 m to 20 m, rays. */
SonarConfig targetSonar(double fov_deg, int beams) {
    SonarConfig config = test::getSonar({.beams = beams, .width_deg = fov_deg, .bins = 200, .rows = 16, .columns = 2});
    config.visibility = Visibility::Cpu;
    return config;
}

/** A level sonar at the origin with one target of 0 dB. */
types::Snapshot withPoint(types::GeometryPtr geometry, glm::dvec3 position, double strength_db = 0) {
    types::Snapshot snapshot = test::makeSnapshot(std::move(geometry));
    snapshot.targets = {{position, strength_db}};
    return snapshot;
}

glm::dvec3 towards(double azimuth_deg, double elevation_deg, double range) {
    const double a = radians(azimuth_deg), e = radians(elevation_deg);
    return range * glm::dvec3(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
}

/** Returns the pattern of one beam in a direction, only by the laws of a configuration. */
double findPattern(const SonarConfig& config, double bearing, double azimuth, double elevation) {
    const auto power = [](const std::optional<acoustics::BeamLaw>& law, double angle, double axis) {
        return law ? acoustics::BeamPattern(*law).power(angle, axis) : 1.0;
    };
    const bool conical = config.beam_geometry == BeamGeometry::Conical;
    const double across = conical ? std::asin(std::sin(azimuth) * std::cos(elevation)) : azimuth;
    const BeamPatternConfig& pattern = *config.beam_pattern;
    return power(pattern.transmit.azimuth, across, 0) * power(pattern.transmit.elevation, elevation, 0) *
           power(pattern.receive.elevation, elevation, 0) *
           (conical ? power(pattern.receive.azimuth, across, bearing)
                    : power(pattern.receive.azimuth, across - bearing, 0));
}

/** Returns the mean of the pulse over a bin, by 2000 points. */
double computeShare(const SonarConfig& config, const BinGrid& grid, int bin, double range) {
    if (!config.pulse) return range >= grid.edge(bin) && range < grid.edge(bin + 1);
    const acoustics::Pulse pulse(*config.pulse, grid.speed_of_sound);
    double sum = 0;
    for (int i = 0; i < 2000; ++i) sum += pulse.response(grid.edge(bin) + (i + 0.5) / 2000 * grid.bin_width - range);
    return sum / 2000;
}

/** The echo of a target in a ping by the sonar equation, without spreading and its strength. */
std::vector<double> getShape(const SonarConfig& config, const types::Sonar& ping, const glm::dvec3& at) {
    const BinGrid grid = makeBinGrid(config);
    const double r = glm::length(at), alpha = config.absorption->db_per_m.value();
    std::vector<double> shares(ping.bin_count), shape(ping.bins.size());
    for (int k = 0; k < grid.bin_count; ++k)
        if (std::abs(grid.centre(k) - r) < 1.2)
            shares[static_cast<size_t>(k)] = computeShare(config, grid, k, r) * std::pow(10, -0.2 * alpha * r);
    for (size_t beam = 0; beam < ping.beam_count; ++beam) {
        const double received =
            findPattern(config, ping.bearings[beam].rad, std::atan2(at.y, at.x), std::asin(at.z / r));
        if (10 * std::log10(received) < config.beam_pattern->floor_db) continue;
        for (size_t k = 0; k < ping.bin_count; ++k) shape[beam * ping.bin_count + k] = received * shares[k];
    }
    return shape;
}

/** Returns the max deviation of a bin from a shape at a level, for bins within 45 dB of the loudest bin [dB]. */
double findWorst(const types::Sonar& ping, const std::vector<double>& shape, double level_db) {
    const double quietest = *std::ranges::max_element(shape) * std::pow(10, -4.5);
    double worst = 0;
    for (size_t i = 0; i < shape.size(); ++i)
        if (shape[i] >= quietest && shape[i] > 0)
            worst = std::max(worst, std::abs(10 * std::log10(ping.bins[i] / shape[i]) - level_db));
    return worst;
}

struct Law {
    const char* name;
    std::function<void(SonarConfig&)> set;
};
const Law patterns[] = {
    {"hann",
     [](SonarConfig& c) {
         c.beam_pattern->receive.azimuth = getLaw(Weighting::Hann, 3);
         c.beam_pattern->transmit.elevation = getLaw(Weighting::Gaussian, 20);
     }},
    {"uniform, two way",
     [](SonarConfig& c) {
         c.beam_pattern->receive = {getLaw(Weighting::Uniform, 4), getLaw(Weighting::Uniform, 15)};
         c.beam_pattern->transmit = {getLaw(Weighting::Cosine, 60), getLaw(Weighting::Taylor, 25)};
     }},
    {"conical",
     [](SonarConfig& c) {
         c.beam_pattern->receive = {getLaw(Weighting::Taylor, 3), getLaw(Weighting::Hamming, 20)};
         c.beam_geometry = BeamGeometry::Conical;
     }},
};
const Law pulses[] = {
    {"no pulse", [](SonarConfig&) {}},
    {"tone", [](SonarConfig& c) { c.pulse.emplace().duration_us = 730; }},
    {"chirp", [](SonarConfig& c) { c.pulse.emplace().bandwidth_khz = 4; }},
    {"long chirp, hann",
     [](SonarConfig& c) {
         c.pulse.emplace().bandwidth_khz = 1.5;
         c.pulse->window = acoustics::PulseWindow::Hann;
     }},
};

/** The places of a target about a beam ahead: azimuth, elevation [deg], range within a bin [m]. */
std::vector<glm::dvec3> places() {
    std::vector<glm::dvec3> all;
    for (const double azimuth : {0.0, 0.7, -1.4, 2.9, 17.3})
        for (const double elevation : {0.0, -4.0, 8.0})
            for (const double range : {10.0001, 10.033, 10.05, 10.0999})
                all.push_back(towards(azimuth, elevation, range));
    return all;
}

TEST(PointTargetTest, HasTheLevelOfTheSonarEquationAtAnyPlaceInTheBeam) {
    double maximum = 0;
    for (const Law& pattern : patterns)
        for (const Law& pulse : pulses)
            for (const double absorption : {0.0, 0.35}) {
                SonarConfig config = targetSonar(40, 21);
                config.beam_pattern.emplace();
                pattern.set(config);
                pulse.set(config);
                config.absorption.emplace().db_per_m = absorption;
                const auto geometry = openWater();
                SonarRenderer renderer(config, geometry);
                types::Sonar ping;
                double worst = 0;
                for (const glm::dvec3& at : places()) {
                    renderer.render(withPoint(geometry, at, -17.5), ping);
                    const std::vector<double> shape = getShape(config, ping, at);
                    const double distance_db = 10 * std::log10(glm::length(at));
                    ASSERT_GT(*std::ranges::max_element(shape), 0);
                    worst = std::max(worst, findWorst(ping, shape, -17.5 - 4 * distance_db));
                    EXPECT_GT(findWorst(ping, shape, -17.5 - 2 * distance_db), 10) << "spread one way alone";
                }
                EXPECT_LT(worst, 0.05) << pattern.name << ", " << pulse.name << ", " << absorption << " dB/m";
                maximum = std::max(maximum, worst);
            }
    RecordProperty("largest difference", std::to_string(maximum) + " dB");
}

TEST(PointTargetTest, ABeamWithoutAPatternReceivesItInItsBoxAndTheAperture) {
    const auto geometry = openWater();
    for (const BeamGeometry fan : {BeamGeometry::Planar, BeamGeometry::Conical}) {
        SonarConfig config = targetSonar(60, 6);
        config.beam_geometry = fan;
        SonarRenderer renderer(config, geometry);
        types::Sonar ping;
        const auto receivedIn = [&](double azimuth_deg, double elevation_deg) {
            renderer.render(withPoint(geometry, towards(azimuth_deg, elevation_deg, 5.03)), ping);
            std::vector<size_t> beams;
            for (size_t i = 0; i < ping.bins.size(); ++i)
                if (ping.bins[i] > 0) {
                    EXPECT_NEAR(10 * std::log10(ping.bins[i]), -40 * std::log10(5.03), 1e-5);
                    EXPECT_EQ(i % ping.bin_count, 50u);
                    beams.push_back(i / ping.bin_count);
                }
            return beams;
        };
        using Beams = std::vector<size_t>;
        EXPECT_EQ(receivedIn(-25, 0), Beams{0});
        EXPECT_EQ(receivedIn(25, 9.9), Beams{5});
        EXPECT_EQ(receivedIn(5, -9.9), Beams{3});
        EXPECT_EQ(receivedIn(5, 10.1), Beams{});
        EXPECT_EQ(receivedIn(31, 0), Beams{});
        EXPECT_EQ(receivedIn(175, 0), Beams{});
        EXPECT_EQ(receivedIn(20.1, 9.9), fan == BeamGeometry::Conical ? Beams{4} : Beams{5}) << "cones bend";
    }
}

/** Energies, ray-traced and rasterised, and fields. */
std::vector<SonarConfig> energiesAndFields(SonarConfig config) {
    std::vector<SonarConfig> all(3, config);
    all[1].visibility = Visibility::Gl;
    all[1].device = "software";
    all[2].speckle.emplace().coherent = true;
    all[2].frequency_khz = 500;
    return all;
}

TEST(PointTargetTest, IsInTheBinOfBinAtOnTheEdgeOfABin) {
    std::mt19937 random(71);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto geometry = openWater();
    types::Sonar ping;
    int tried = 0;
    for (int round = 0; round < 12; ++round) {
        SonarConfig fan = targetSonar(60, 7);
        fan.range = uniform(5, 30);
        fan.range_rounding = round % 2 == 0 ? RangeRounding::Exact : RangeRounding::Sample;
        fan.speed_of_sound = uniform(1400, 1600);
        const BinGrid grid = makeBinGrid(fan);
        for (const SonarConfig& config : energiesAndFields(fan)) {
            const auto expectEchoes = [&](const SonarConfig& sonar, const auto& expect) {
                SonarRenderer renderer(sonar, geometry);
                for (int k = 20 + round; k < grid.bin_count - 20; k += 12, ++tried) {
                    ASSERT_EQ(binAt(grid.edge(k), grid.bin_width), k);
                    renderer.render(withPoint(geometry, {grid.edge(k), 0, 0}), ping);
                    expect(k, std::span(ping.bins).subspan(3 * ping.bin_count, ping.bin_count));  // of the middle beam
                }
            };
            expectEchoes(config, [&](int k, std::span<const float> beam) {
                EXPECT_GT(beam[static_cast<size_t>(k)], 0) << grid.edge(k) << " m";
                EXPECT_EQ(std::ranges::count_if(ping.bins, [](float echo) { return echo > 0; }), 1);
            });
            SonarConfig pulsed = config;
            pulsed.pulse.emplace().bandwidth_khz = grid.speed_of_sound / 2 / (3 * grid.bin_width) / 1000;  // 3 bins
            expectEchoes(pulsed, [&](int k, std::span<const float> beam) {
                double sum = 0, moment = 0;
                for (int i = k - 6; i < k + 6; ++i) {
                    const double energy = double{beam[static_cast<size_t>(i)]};
                    sum += energy, moment += energy * (i + 0.5 - k);
                }
                EXPECT_NEAR(moment / sum, 0, 0.5) << "bins from the edge at " << grid.edge(k) << " m";
            });
        }
    }
    EXPECT_GT(tried, 800);
}

TEST(PointTargetTest, IsInOneBeamOnlyAtAnyBearing) {
    SonarConfig config = targetSonar(360, 12);
    const auto geometry = openWater();
    for (double azimuth = -180; azimuth < 180; azimuth += 7.3) {
        const types::Sonar ping = makePing(config, withPoint(geometry, towards(azimuth, 0, 5)));
        EXPECT_EQ(std::ranges::count_if(ping.bins, [](float x) { return x > 0; }), 1) << azimuth;
    }
}

/** Returns the echo of a target that is swept about one beam. */
BeamCut sweep(const SonarConfig& config, bool in_azimuth) {
    const auto geometry = openWater();
    SonarRenderer renderer(config, geometry);
    types::Sonar ping;
    constexpr double step = 0.02;
    std::vector<double> level;
    for (double angle = 0; angle < 12; angle += step) {
        const glm::dvec3 at = in_azimuth ? towards(angle, 0, 10.05) : towards(0, angle, 10.05);
        renderer.render(withPoint(geometry, at), ping);
        level.push_back(test::computeSum(ping));
    }
    return BeamCut(level, 0, step);
}

TEST(PointTargetTest, ShowsTheTableOfWeightingsWhenSweptAcrossABeam) {
    for (const test::WeightingRow& row : test::weightings)
        for (const bool in_azimuth : {true, false}) {
            acoustics::BeamLaw law = row.law();
            law.width_deg = 3;
            SonarConfig config = targetSonar(2, 1);
            (in_azimuth ? config.beam_pattern.emplace().receive.azimuth
                        : config.beam_pattern.emplace().receive.elevation) = law;
            sweep(config, in_azimuth).expect(row);
        }
}

TEST(PointTargetTest, SidelobesReachItOutsideFanAndApertureToTheFloor) {
    SonarConfig config = targetSonar(20, 10);
    config.beam_pattern.emplace().receive.azimuth = getLaw(Weighting::Uniform, 2);
    const auto geometry = openWater();
    const auto outside = withPoint(geometry, towards(35.3, 0, 10.05));
    const types::Sonar received = makePing(config, outside);
    const double top = *std::ranges::max_element(received.bins) * std::pow(10.05, 4);
    EXPECT_LT(10 * std::log10(top), -25);
    EXPECT_GT(10 * std::log10(top), -60);
    config.beam_pattern->floor_db = -20;
    EXPECT_EQ(test::computeSum(makePing(config, outside)), 0);
}

TEST(PointTargetTest, IsSilentBelowRangeMinAndOnlyItsPulseReachesIntoTheRange) {
    SonarConfig config = targetSonar(20, 1);
    config.range_min = 2;
    const auto geometry = openWater();
    EXPECT_EQ(test::computeSum(makePing(config, withPoint(geometry, {1.999, 0, 0}))), 0);
    EXPECT_GT(test::computeSum(makePing(config, withPoint(geometry, {2.001, 0, 0}))), 0);
    EXPECT_EQ(test::computeSum(makePing(config, withPoint(geometry, {0, 0, 0}))), 0);
    EXPECT_EQ(test::computeSum(makePing(config, withPoint(geometry, {20.01, 0, 0}))), 0);
    config.pulse.emplace().duration_us = 1000;  // half a metre
    EXPECT_GT(test::computeSum(makePing(config, withPoint(geometry, {20.2, 0, 0}))), 0);
    EXPECT_EQ(test::computeSum(makePing(config, withPoint(geometry, {20.3, 0, 0}))), 0);
}

/** A plate of 1 m square to the x axis. */
types::GeometryPtr plate(double x, double y = 0) {
    return test::makeScene({test::quad({0, -0.5f, -0.5f}, {0, 1, 0}, {0, 0, 1})}, 0, {{x, y, 0}});
}

TEST(PointTargetTest, IsHiddenByObjectsInsideTheFanAndOutside) {
    SonarConfig config = targetSonar(40, 20);
    config.beam_pattern.emplace().receive.azimuth = getLaw(Weighting::Uniform, 2);
    for (const SonarConfig& way : everyRenderer(config)) {
        const auto computeReceived = [&](const types::GeometryPtr& geometry, const glm::dvec3& at) {
            types::Snapshot with = withPoint(geometry, at, 20), without = with;
            without.targets.clear();
            return test::computeSum(makePing(way, with)) - test::computeSum(makePing(way, without));
        };
        const double open = computeReceived(openWater(), {10, 0, 0});
        EXPECT_GT(open, 0);
        EXPECT_EQ(computeReceived(plate(5), {10, 0, 0}), 0) << "before it";
        EXPECT_NEAR(computeReceived(plate(10.5), {10, 0, 0}), open, 1e-3 * open) << "behind it";
        EXPECT_NEAR(computeReceived(plate(10), {10, 0, 0}), open, 1e-3 * open) << "on it";
        EXPECT_NEAR(computeReceived(plate(5, 0.6), {10, 0, 0}), open, 1e-3 * open) << "next to it";
        EXPECT_GT(computeReceived(openWater(), {10, 10, 0}), 0) << "outside the fan";
        EXPECT_EQ(computeReceived(plate(5, 5), {10, 10, 0}), 0);
    }
}

TEST(PointTargetTest, IsUncoveredByAnObjectThatMovesAside) {
    const auto geometry = plate(5);
    SonarRenderer renderer(targetSonar(40, 20), geometry);
    types::Sonar ping;
    types::Snapshot snapshot = withPoint(geometry, {10, 0, 0}, 60);
    const auto targetsReceived = [&] {
        renderer.render(snapshot, ping);
        return renderer.othersReceived();
    };
    const auto getReason = [&]() -> std::optional<Reason> {
        for (const Omitted& what : renderer.omissions())
            if (what.effect == "point targets") return what.reason;
        return {};
    };
    EXPECT_EQ(targetsReceived(), 0u);
    EXPECT_EQ(getReason(), Reason::OutOfView);
    snapshot.moved = {{0, glm::translate(glm::dmat4(1), {5.0, 3.0, 0.0})}};
    EXPECT_EQ(targetsReceived(), 1u);
    EXPECT_EQ(getReason(), std::nullopt);
    snapshot.moved.clear();
    EXPECT_EQ(targetsReceived(), 0u) << "back where the scene has it";
    snapshot.targets.clear();
    EXPECT_EQ(targetsReceived(), 0u);
    EXPECT_EQ(getReason(), Reason::NoneInScene);
}

TEST(PointTargetTest, IsTheSameFarFromTheOriginAndRotated) {
    SonarConfig config = targetSonar(40, 20);
    const auto near = openWater();
    types::Snapshot snapshot = test::makeSnapshot(near, {4e6, -3e6, -200}, 1.1, 0.3, 0.2);
    snapshot.targets = {{snapshot.sonar.position + snapshot.sonar.orientation * towards(7.3, -5, 12.34), -10}};
    const types::Sonar far = makePing(config, snapshot),
                       here = makePing(config, withPoint(near, towards(7.3, -5, 12.34), -10));
    for (size_t i = 0; i < far.bins.size(); ++i) EXPECT_NEAR(far.bins[i], here.bins[i], 1e-6 * here.bins[i]) << i;
}

TEST(PointTargetTest, AnEmptyListChangesNoBit) {
    SonarConfig config = targetSonar(40, 20);
    config.pulse.emplace().bandwidth_khz = 4;
    const auto geometry = test::makeScene({test::ground(-2), test::sphere(1, 20)}, 0, {{0, 0, 0}, {8, 0, 0}});
    for (const Model model : {Model::Physical, Model::Cerqueira2017}) {
        config.model = model;
        if (model == Model::Cerqueira2017) config.pulse.reset();
        const types::Sonar plain = makePing(config, test::makeSnapshot(geometry));
        EXPECT_EQ(makePing(config, withPoint(geometry, {5, 0, 0}, -3000)).bins, plain.bins);
        const types::Sonar loud = makePing(config, withPoint(geometry, {5, 0, 0}, 0));
        EXPECT_EQ(loud.bins == plain.bins, model == Model::Cerqueira2017) << "means know no targets";
    }
}

}  // namespace
}  // namespace insonify::sonar
