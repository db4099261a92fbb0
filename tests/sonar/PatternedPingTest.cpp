// Pings of sonars with beam patterns and pulses, compared with closed forms and the properties of apertures
// (ACOUSTICS.md 5.8 to 5.13).
#include <gmock/gmock.h>

#include <numbers>
#include <numeric>

#include "tests/sonar/BeamCut.hpp"
#include "tests/support/ClosedForms.hpp"
#include "tests/support/EveryRenderer.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using acoustics::Weighting;
using test::everyRenderer;
using test::expectForm;
using test::getLaw;
using test::makePing;
using types::radians;

SonarConfig patternedSonar(double fov_deg, int beams, double bin, int bins) {
    return test::getSonar({.beams = beams, .width_deg = fov_deg, .bins = bins, .bin = bin, .rows = 512, .columns = 2});
}

/** Form 3 weighted by a share for each elevation: a flat bottom under a thin beam that looks down by `pitch`, or under
 * a level fan. */
test::Form weightedBottom(double height, double pitch, double delta, const std::function<double(double)>& share) {
    return [=](double r1, double r2) {
        const auto density = [=](double r) {
            if (r <= height) return 0.0;
            const double down = std::asin(height / r);
            return delta * height * height * std::pow(r, -5) * std::cos(pitch - down) / std::cos(down) *
                   share(pitch - down);
        };
        return test::integral(r1, r2, density);
    };
}

/** A bottom echoes by the two-way pattern in elevation, and not by patterns that differ. */
void expectElevationPattern(SonarConfig config, double sent_deg, double received_deg, double height, double pitch,
                            double delta) {
    config.beam_pattern.emplace().transmit.elevation = getLaw(Weighting::Gaussian, sent_deg);
    config.beam_pattern->receive.elevation = getLaw(Weighting::Gaussian, received_deg);
    config.beam_pattern->floor_db = -80;
    const acoustics::BeamPattern sent(*config.beam_pattern->transmit.elevation),
        received(*config.beam_pattern->receive.elevation);
    const auto snapshot =
        test::makeSnapshot(test::makeScene({test::ground(static_cast<float>(-height))}), {}, 0, pitch);
    const auto getForm = [&](double tilt, const auto& share) { return weightedBottom(height, tilt, delta, share); };
    const auto both_ways = [&](double e) { return sent.power(e) * received.power(e); };
    const auto right = getForm(pitch, both_ways);
    std::vector<test::Form> wrong = {getForm(pitch, [&](double e) { return sent.power(e); }),
                                     getForm(pitch, [](double) { return 1.0; })};
    if (pitch != 0) wrong.push_back(getForm(0, both_ways));
    for (const SonarConfig& way : everyRenderer(config)) {
        const types::Sonar ping = makePing(way, snapshot);
        const test::Deviation off = test::deviation(ping, right);
        EXPECT_LT(off.relative_l2, 0.01) << off;
        EXPECT_LT(off.ripple, 0.01) << off;
        testing::Test::RecordProperty("relative_l2", std::to_string(off.relative_l2));
        for (const test::Form& each : wrong) EXPECT_GT(test::deviation(ping, each).relative_l2, 0.1);
    }
}

TEST(PatternedPingTest, ABottomEchoesByThePatternInElevation) {
    expectElevationPattern(patternedSonar(60, 16, 0.1, 300), 16, 20, 2.5, 0, radians(60.0 / 16));
}

TEST(PatternedPingTest, APitchedBottomEchoesByThePatternInElevation) {
    expectElevationPattern(patternedSonar(1, 1, 0.1, 300), 12, 16, 4, radians(20), radians(1));
}

TEST(PatternedPingTest, ABottomEchoesByThePatternsWholeWidthInAzimuth) {
    SonarConfig config = patternedSonar(60, 30, 0.1, 200);
    config.beam_height_deg = 40;
    config.beam_pattern.emplace().receive.azimuth = getLaw(Weighting::Hann, 3);
    config.beam_pattern->floor_db = -90;
    const acoustics::BeamPattern received(*config.beam_pattern->receive.azimuth);
    double delta = 0;
    for (double azimuth = -std::numbers::pi / 2; azimuth < std::numbers::pi / 2; azimuth += 1e-5)
        delta += 1e-5 * received.power(azimuth);
    const auto snapshot = test::makeSnapshot(test::makeScene({test::ground(-5)}));
    for (const SonarConfig& way : everyRenderer(config))
        expectForm(makePing(way, snapshot), test::flatBottom(5, radians(20), delta),
                   test::flatBottom(5, radians(20), radians(2)));
}

TEST(PatternedPingTest, APulseOfOneBinChangesNoBit) {
    SonarConfig config = patternedSonar(60, 16, 0.1, 300);
    const auto snapshot = test::makeSnapshot(test::makeScene({test::ground(-5), test::wall(20)}), {}, 0.1, 0.2);
    const types::Sonar plain = makePing(config, snapshot);
    acoustics::PulseConfig pulse;
    pulse.duration_us = 200;  // a bin of 0.1 m at 1000 m/s
    config.pulse = pulse;
    EXPECT_EQ(makePing(config, snapshot).bins, plain.bins);
    config.pulse->duration_us = 600;
    EXPECT_NE(makePing(config, snapshot).bins, plain.bins);
}

TEST(PatternedPingTest, ThePlanStatesBeamFormingAndPulseSpreading) {
    const auto geometry = test::makeScene({test::ground(-5)});
    SonarConfig config = patternedSonar(60, 16, 0.1, 300);
    const RenderPlan plain = makeRenderPlan(config, *geometry);
    EXPECT_FALSE(plain.has(Pass::Beamform) || plain.has(Pass::Pulse));
    for (const char* const effect : {"azimuth beam pattern", "elevation beam pattern", "range point-spread"}) {
        ASSERT_TRUE(plain.findOmitted(effect));
        EXPECT_EQ(plain.findOmitted(effect)->reason, Reason::NotConfigured);
    }
    EXPECT_EQ(plain.cells.size(), plain.beams.size());
    config.beam_pattern.emplace().receive.azimuth = getLaw(Weighting::Hann, 3);
    config.pulse.emplace().duration_us = 90;  // resolves 0.045 m, in bins of 0.1 m
    const RenderPlan formed = makeRenderPlan(config, *geometry);
    EXPECT_TRUE(formed.has(Pass::Beamform));
    EXPECT_FALSE(formed.findOmitted("azimuth beam pattern"));
    EXPECT_TRUE(formed.findOmitted("elevation beam pattern"));
    EXPECT_GT(formed.cells.size(), 2 * formed.beams.size());
    EXPECT_FALSE(formed.has(Pass::Pulse));
    ASSERT_TRUE(formed.findOmitted("range point-spread"));
    EXPECT_EQ(formed.findOmitted("range point-spread")->reason, Reason::BelowBound);
    EXPECT_DOUBLE_EQ(formed.findOmitted("range point-spread")->value, 0.045);
    config.pulse->duration_us = 300;
    EXPECT_TRUE(makeRenderPlan(config, *geometry).has(Pass::Pulse));
}

/** Returns the echo of a small disc straight ahead in a fan of close beams. */
BeamCut makeCut(const acoustics::BeamLaw& law) {
    SonarConfig config = patternedSonar(24, 601, 0.5, 24);
    config.beam_height_deg = 2;
    config.quality.rows = 64;
    config.beam_pattern.emplace().receive.azimuth = law;
    const types::Sonar ping = makePing(config, test::makeSnapshot(test::makeScene({test::disc(10.25f, 0.01f)}, -10)));
    std::vector<double> level;
    for (size_t beam = 0; beam < ping.beam_count; ++beam) {
        const auto first = ping.bins.begin() + static_cast<long>(beam * ping.bin_count);
        level.push_back(std::accumulate(first, first + ping.bin_count, 0.0));
    }
    return BeamCut(level, 300, 24.0 / 601);
}

TEST(PatternedPingTest, ATargetSweptAcrossABeamShowsTheTableOfWeightings) {
    for (const test::WeightingRow& row : test::weightings) {
        if (row.weighting == Weighting::Piston) continue;
        acoustics::BeamLaw law = row.law();
        law.width_deg = 3;
        makeCut(law).expect(row);
    }
}

/** A measured beam: asymmetric, with a shoulder. */
struct MeasuredBeam {
    Folder folder;
    std::vector<double> angle{-12, -8, -6, -5, -4, -3, -2, -1, 0, 1, 2, 2.5, 3, 4, 6, 8, 12};
    std::vector<double> level{-70, -50, -28, -22, -25, -16, -7, -1.5, 0, -1, -4, -4.5, -8, -15, -26, -40, -70};

    acoustics::BeamLaw law() const {
        std::ofstream file(folder / "measured.csv");
        file << "angle_deg,level_db\n";
        for (size_t i = 0; i < angle.size(); ++i) file << angle[i] << "," << level[i] << "\n";
        acoustics::BeamLaw law;
        law.file = folder / "measured.csv";
        return law;
    }
    double at(double degrees) const { return acoustics::Curve{angle, level}.at(degrees); }
};

TEST(PatternedPingTest, ATargetSweptAcrossAMeasuredBeamShowsItsTable) {
    const MeasuredBeam beam;
    SonarConfig config = patternedSonar(18, 361, 0.5, 24);
    config.beam_height_deg = 2;
    config.quality.rows = 256;
    config.quality.columns_per_beam = 4;
    config.beam_pattern.emplace().receive.azimuth = beam.law();
    const auto snapshot = test::makeSnapshot(test::makeScene({test::disc(10.25f, 0.004f)}, -10));
    for (const SonarConfig& way : everyRenderer(config)) {
        const types::Sonar ping = makePing(way, snapshot);
        std::vector<double> energy;
        for (size_t k = 0; k < ping.beam_count; ++k) {
            const auto first = ping.bins.begin() + static_cast<long>(k * ping.bin_count);
            energy.push_back(std::accumulate(first, first + ping.bin_count, 0.0));
        }
        double worst = 0, worst_mirrored = 0;
        for (size_t k = 0; k < energy.size(); ++k) {
            const double off = -ping.bearings[k].deg(), level = 10 * std::log10(energy[k] / energy[180]);
            worst = std::max(worst, std::abs(level - beam.at(off)));
            worst_mirrored = std::max(worst_mirrored, std::abs(level - beam.at(-off)));
        }
        EXPECT_LT(worst, 0.1);
        EXPECT_GT(worst_mirrored, 1);
        RecordProperty("worst_db", std::to_string(worst));
    }
}

TEST(PatternedPingTest, AStrongTargetsSidelobesAreAnArcAcrossTheFan) {
    SonarConfig config = patternedSonar(90, 90, 0.2, 100);
    config.beam_pattern.emplace().receive.azimuth = getLaw(Weighting::Uniform, 1);
    const types::Sonar ping = makePing(config, test::makeSnapshot(test::makeScene({test::disc(10.1f, 0.1f)})));
    for (size_t beam = 0; beam < ping.beam_count; ++beam) {
        const auto first = ping.bins.begin() + static_cast<long>(beam * ping.bin_count);
        EXPECT_GT(first[50], 0) << beam;
        EXPECT_EQ(first[40], 0) << beam;
        EXPECT_EQ(first[60], 0) << beam;
    }
}

TEST(PatternedPingTest, AChirpsEchoHasTheWidthOfItsBandwidthAndTheRightRange) {
    SonarConfig config = patternedSonar(2, 1, 0.01, 1200);
    config.beam_height_deg = 2;
    config.quality.columns_per_beam = 64;
    config.pulse.emplace().bandwidth_khz = 5;  // c / 2B = 0.1 m
    const types::Sonar ping = makePing(config, test::makeSnapshot(test::makeScene({test::disc(6.005f, 0.02f)})));
    const auto top = std::max_element(ping.bins.begin(), ping.bins.end()) - ping.bins.begin();
    EXPECT_NEAR((static_cast<double>(top) + 0.5) * 0.01, 6.005, 0.01);
    long k = top;
    while (ping.bins[static_cast<size_t>(k)] > 0.5f * ping.bins[static_cast<size_t>(top)]) ++k;
    EXPECT_NEAR(2 * (static_cast<double>(k - top) - 0.5) * 0.01, 0.0886, 0.012);
    float sidelobe = 0;
    for (size_t j = static_cast<size_t>(top) + 10; j < ping.bins.size(); ++j)
        sidelobe = std::max(sidelobe, ping.bins[j]);
    EXPECT_NEAR(10 * std::log10(sidelobe / ping.bins[static_cast<size_t>(top)]), -13.3, 0.3);
}

}  // namespace
}  // namespace insonify::sonar
