// Errors of a device's elements, beams, focus and clock, compared with closed forms (ACOUSTICS.md 5.27).
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "components/sonar/beams/Directivity.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/Refused.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using acoustics::Weighting;
using std::numbers::pi;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using types::radians;
using Phasor = std::complex<double>;

constexpr double array_wavelength = 0.002;

/** A fan of 41 beams over 40 deg, whose receiving array is 32 wavelengths long: 64 elements. */
SonarConfig imperfectFan(Weighting weighting = Weighting::Uniform) {
    SonarConfig config =
        test::getSonar({.beams = 41, .width_deg = 40, .height_deg = 60, .bins = 100, .rows = 32, .columns = 2});
    config.visibility = Visibility::Cpu;
    config.speed_of_sound = 1500;
    config.frequency_khz = 750;
    config.beam_pattern.emplace().receive.azimuth.emplace().weighting = weighting;
    config.beam_pattern->receive.azimuth->aperture_m = 32 * array_wavelength;
    return config;
}

SonarConfig withErrors(SonarConfig config, const ImperfectionsConfig& errors) {
    config.imperfections = errors;
    return config;
}

types::Snapshot flatBottom() {
    return test::makeSnapshot(test::makeScene({test::ground(-2), test::sphere(0.5, 16)}, 0, {{}, {6, 1, -1.5}}));
}

types::Sonar imperfectPing(const SonarConfig& config, const types::Snapshot& snapshot = flatBottom()) {
    SonarRenderer renderer(config, snapshot.geometry);
    types::Sonar ping;
    renderer.render(snapshot, ping);
    return ping;
}

TEST(ImperfectionsTest, SidelobesRiseByTheVarianceOfTheErrorsOverTheElements) {
    struct Case {
        double gain_db, phase_deg, dead;
    };
    for (const Weighting weighting : {Weighting::Uniform, Weighting::Taylor})
        for (const auto& [gain_db, phase_deg, dead] :
             {Case{1, 0, 0}, Case{0, 8, 0}, Case{1, 8, 0}, Case{0, 0, 0.05}, Case{2, 20, 0.1}}) {
            const SonarConfig ideal = imperfectFan(weighting);
            const Directivity without(ideal);
            const double s = gain_db * std::log(10) / 20, p = radians(phase_deg), alive = 1 - dead;
            // Moments of (alive) exp(s n) exp(i p n'), n and n' N(0, 1).
            const double mean = alive * std::exp(0.5 * (s * s - p * p)), power = alive * std::exp(2 * s * s);
            double weights = 0;
            for (const double w : acoustics::elementWeights(64, 32, acoustics::Taper(weighting))) weights += w * w;
            double drawn = 0, expected = 0, small = 0;
            constexpr int seeds = 300;
            for (int seed = 0; seed < seeds; ++seed) {
                ImperfectionsConfig errors{.seed = static_cast<uint32_t>(seed),
                                           .gain_error_db = gain_db,
                                           .phase_error_deg = phase_deg,
                                           .dead_element_share = dead};
                const Directivity with(withErrors(ideal, errors));
                for (double angle = radians(10); angle < radians(60); angle += radians(2.7)) {
                    const double clean = without.azimuth(angle, 0);
                    drawn += with.azimuth(angle, 0) - mean * mean * clean;
                    expected += weights * (power - mean * mean);
                    small += weights * (s * s + p * p);
                }
            }
            const double off = 10 * std::log10(drawn / expected);
            EXPECT_NEAR(off, 0, 0.5) << gain_db << " dB " << phase_deg << " deg " << dead;
            if (dead > 0 || gain_db >= 2) continue;
            EXPECT_NEAR(10 * std::log10(drawn / small), 0, 0.5) << "of small errors";
        }
}

TEST(ImperfectionsTest, ADeadElementInTheMiddleTakesItsShareOffTheFieldEverywhere) {
    ImperfectionsConfig errors;
    errors.elements = 25;
    errors.dead_elements = {12};
    SonarConfig config = withErrors(imperfectFan(), errors);
    const Directivity with(config);
    for (double angle = -radians(80); angle < radians(80); angle += radians(0.31)) {
        const double u = 32 * std::sin(angle), sinc = std::abs(u) < 1e-9 ? 1 : std::sin(pi * u) / (pi * u);
        EXPECT_NEAR(with.azimuth(angle, 0), std::pow(sinc - 1.0 / 25, 2), 1e-5) << angle;
    }
    config.beam_geometry = BeamGeometry::Conical;
    const Directivity straight(config);
    const double u = 32 * (std::sin(0.5) - std::sin(0.3));
    EXPECT_NEAR(straight.azimuth(0.5, 0.3), std::pow(std::sin(pi * u) / (pi * u) - 1.0 / 25, 2), 1e-5);
}

TEST(ImperfectionsTest, WithoutErrorsBitsAreTheSame) {
    SonarConfig plain = imperfectFan(), coherent = imperfectFan(Weighting::Taylor), boxes = imperfectFan();
    coherent.speckle.emplace().coherent = true;
    boxes.beam_pattern.reset();
    for (const SonarConfig& config : {plain, coherent, boxes})
        EXPECT_EQ(imperfectPing(withErrors(config, {.seed = 9})).bins, imperfectPing(config).bins);
}

TEST(ImperfectionsTest, APointTargetShowsThePatternOfThisDeviceWithAndWithoutCoherence) {
    const ImperfectionsConfig errors{.gain_error_db = 2, .phase_error_deg = 25};
    types::Snapshot snapshot = test::makeSnapshot(test::openWater());
    snapshot.targets = {{glm::dvec3(8 * std::cos(0.1), 8 * std::sin(0.1), 0), 0}};
    for (const bool is_coherent : {false, true}) {
        SonarConfig config = withErrors(imperfectFan(), errors);
        config.beam_pattern->floor_db = -90;
        if (is_coherent) config.speckle.emplace().coherent = true;
        const types::Sonar ping = imperfectPing(config, snapshot);
        const Directivity pattern(config);
        for (size_t beam = 0; beam < ping.beam_count; ++beam) {
            double sum = 0;
            for (size_t k = 0; k < ping.bin_count; ++k)
                sum += static_cast<double>(ping.bins[beam * ping.bin_count + k]);
            const double expected = pattern.azimuth(0.1, ping.bearings[beam].rad) / std::pow(8, 4);
            EXPECT_NEAR(sum, expected, 0.02 * expected + 1e-11) << beam << " " << is_coherent;
        }
    }
}

TEST(ImperfectionsTest, CoherentSurfacesHaveTheSidelobesOfEnergies) {
    const ImperfectionsConfig errors{.gain_error_db = 3, .phase_error_deg = 40, .dead_element_share = 0.1};
    const types::Snapshot snapshot = test::makeSnapshot(test::makeScene({test::sphere(0.3, 32)}, 0, {{7, 0.6, 0}}));
    const auto sidelobes = [&](bool is_coherent, const std::optional<ImperfectionsConfig>& own) {
        SonarConfig config = imperfectFan(Weighting::Taylor);
        config.imperfections = own;
        config.beam_pattern->floor_db = -80;
        config.bin_count = 100;
        if (is_coherent) config.speckle.emplace().coherent = true;
        const types::Sonar ping = imperfectPing(config, snapshot);
        double side = 0, all = 0;
        for (size_t beam = 0; beam < ping.beam_count; ++beam)
            for (size_t k = 0; k < ping.bin_count; ++k) {
                const auto bin = static_cast<double>(ping.bins[beam * ping.bin_count + k]);
                all += bin;
                if (std::abs(ping.bearings[beam].rad - std::atan2(0.6, 7)) > radians(6)) side += bin;
            }
        return 10 * std::log10(side / all);
    };
    const double energies = sidelobes(false, errors), fields = sidelobes(true, errors);
    EXPECT_NEAR(fields, energies, 2) << "one realization of speckle";
    EXPECT_GT(fields, sidelobes(true, {}) + 6) << "an ideal device has lower sidelobes";
}

/** Returns the response of an array to a point at a range and angle, by the exact paths to its elements, focused at
 *  another range. */
double exactPower(double length, size_t count, double range, double angle, double focus) {
    Phasor sum;
    const double k = 2 * pi / array_wavelength;
    for (size_t m = 0; m < count; ++m) {
        const double y = length * acoustics::elementPlace(m, count);
        const double way = std::hypot(range * std::cos(angle), range * std::sin(angle) - y) - range;
        const double delay = std::hypot(focus, y) - focus;
        sum += std::polar(1.0 / static_cast<double>(count), -k * (way - delay));
    }
    return std::norm(sum);
}

/** Returns the width between the outermost half-power points of a pattern, relative to its maximum [rad]. */
double mainLobeWidth(const std::function<double(double)>& power) {
    double top = 0, low = 0, high = 0;
    for (double a = -0.3; a <= 0.3; a += 2e-4) top = std::max(top, power(a));
    for (double a = -0.3; a <= 0.3; a += 2e-4)
        if (power(a) > 0.5 * top) {
            if (low == 0) low = a;
            high = a;
        }
    return high - low;
}

TEST(ImperfectionsTest, ABeamOutOfFocusMatchesTheExactSumOverTheArray) {
    constexpr double length = 0.2;  // far field beyond 20 m
    for (const double focus : {1.5, 4.0, 1e5}) {
        SonarConfig config = imperfectFan();
        config.range = 30;
        config.beam_pattern->receive.azimuth->aperture_m = length;
        config.imperfections.emplace().focus_m = focus;
        const Directivity pattern(config);
        EXPECT_GT(pattern.zoneCount(), 3u);
        EXPECT_LT(pattern.zoneCount(), 60u);
        for (const double range : {0.7, 1.0, 1.5, 2.5, 4.0, 8.0, 29.0}) {
            const size_t zone = pattern.zoneAt(range);
            const auto ours = [&](double angle) { return pattern.azimuth(angle, 0, zone); };
            const auto exact = [&](double angle) { return exactPower(length, 100, range, angle, focus); };
            const double wide = mainLobeWidth(exact), slack = 0.12 * wide + 5e-4;
            EXPECT_NEAR(mainLobeWidth(ours), wide, slack) << range << " m focused at " << focus;
            double off = 0, all = 0;
            for (double angle = -0.2; angle < 0.2; angle += 1e-3) {
                off += std::abs(ours(angle) - exact(angle));
                all += exact(angle);
            }
            EXPECT_LT(off, 0.17 * all) << range << " m focused at " << focus;
        }
    }
}

TEST(ImperfectionsTest, ABeamInFocusOrInTheFarFieldMatchesTheLaw) {
    SonarConfig config = imperfectFan(Weighting::Hann);
    config.range = 200;
    const Directivity ideal(config);
    for (const double focus : {3.0, 1e5}) {
        config.imperfections.emplace().focus_m = focus;
        const Directivity pattern(config);
        const double range = focus == 1e5 ? 199 : 3;
        for (double angle = -0.5; angle < 0.5; angle += 0.003)
            EXPECT_NEAR(pattern.azimuth(angle, 0, pattern.zoneAt(range)), ideal.azimuth(angle, 0), 1e-9) << angle;
    }
}

TEST(ImperfectionsTest, ATargetNearAnArrayThatIsFocusedFarBlooms) {
    SonarConfig config = imperfectFan();
    config.beam_pattern->receive.azimuth->aperture_m = 0.15;
    const auto beamsOver = [&](double range, bool is_focused) {
        SonarConfig own = config;
        if (!is_focused) own.imperfections.emplace().focus_m = 10;
        types::Snapshot snapshot = test::makeSnapshot(test::makeScene({test::sphere(0.02, 32)}, 0, {{range, 0, 0}}));
        const types::Sonar ping = imperfectPing(own, snapshot);
        std::vector<double> sums(ping.beam_count);
        for (size_t i = 0; i < ping.bins.size(); ++i) sums[i / ping.bin_count] += static_cast<double>(ping.bins[i]);
        const double top = std::ranges::max(sums);
        return std::ranges::count_if(sums, [&](double sum) { return sum > 0.1 * top; });
    };
    EXPECT_GT(beamsOver(0.8, false), 3 * beamsOver(0.8, true));
    EXPECT_EQ(beamsOver(10, false), beamsOver(10, true));
}

TEST(ImperfectionsTest, DeadBeamsAreEmptyInTheOrderOfTheTableAndOthersKeepTheirBits) {
    SonarConfig config = imperfectFan();
    config.bearings_deg = {10, -10, 5, 0, -5, 15};
    config.field_of_view_deg.reset();
    config.beam_width_deg = 2;
    const types::Sonar whole = imperfectPing(config), some = imperfectPing(withErrors(config, {.dead_beams = {1, 5}}));
    for (size_t i = 0; i < whole.bins.size(); ++i) {
        const size_t beam = i / whole.bin_count;
        EXPECT_EQ(some.bins[i], beam == 1 || beam == 5 ? 0.0f : whole.bins[i]) << beam;
    }
}

TEST(ImperfectionsTest, SharesAndGainsOfBeamsAreDrawnByTheSeed) {
    ImperfectionsConfig errors{.beam_gain_error_db = 1.5, .dead_beam_share = 0.1};
    double dead = 0, mean = 0, square = 0;
    const std::vector<float> factors = errors.beamFactors(20000);
    for (const float factor : factors) {
        if (factor == 0) {
            ++dead;
            continue;
        }
        const double db = 10 * std::log10(static_cast<double>(factor));
        mean += db, square += db * db;
    }
    EXPECT_NEAR(dead / 20000, 0.1, 0.01);
    EXPECT_NEAR(mean / (20000 - dead), 0, 0.05);
    EXPECT_NEAR(std::sqrt(square / (20000 - dead)), 1.5, 0.03);
    EXPECT_EQ(errors.beamFactors(300), ImperfectionsConfig(errors).beamFactors(300));
    errors.seed = 2;
    EXPECT_NE(errors.beamFactors(20000), factors);
}

TEST(ImperfectionsTest, CrosstalkPutsAShareOfEachBeamIntoItsNeighbours) {
    const SonarConfig config = imperfectFan();
    const types::Sonar clean = imperfectPing(config), mixed = imperfectPing(withErrors(config, {.crosstalk_db = -20}));
    const size_t n = clean.bin_count;
    for (size_t i = n; i + n < clean.bins.size(); ++i)
        EXPECT_FLOAT_EQ(mixed.bins[i], clean.bins[i] + 0.01f * clean.bins[i - n] + 0.01f * clean.bins[i + n]);
    EXPECT_FLOAT_EQ(mixed.bins[3], clean.bins[3] + 0.01f * clean.bins[n + 3]);
}

TEST(ImperfectionsTest, AClockThatJittersSamplesAllBeamsAtTheSameWrongTimes) {
    SonarConfig config = imperfectFan();
    config.bin_count = 400;
    const types::Sonar clean = imperfectPing(config);
    const auto jittered = [&](double sd_bins, int64_t time) {
        types::Snapshot snapshot = flatBottom();
        snapshot.time.microseconds = time;
        return imperfectPing(
            withErrors(config, {.clock_jitter_us = sd_bins * 2e6 * clean.binSeconds()}),  // there and back
            snapshot);
    };
    const types::Sonar one = jittered(0.3, 5), again = jittered(0.3, 5), next = jittered(0.3, 6);
    EXPECT_EQ(one.bins, again.bins);
    EXPECT_NE(one.bins, next.bins);
    EXPECT_NE(one.bins, clean.bins);
    // The shift of each bin, by the slope of the level, is the same for all beams and has the configured deviation.
    double square = 0, count = 0;
    for (size_t k = 200; k + 2 < clean.bin_count; ++k) {
        double top = 0, bottom_sum = 0;
        for (size_t beam = 0; beam < clean.beam_count; ++beam) {
            const float* bins = &clean.bins[beam * clean.bin_count + k];
            const double moved =
                static_cast<double>(one.bins[beam * clean.bin_count + k]) - static_cast<double>(bins[0]);
            const double slope = moved * static_cast<double>(bins[1] - bins[0]) > 0
                                     ? static_cast<double>(bins[1] - bins[0])
                                     : static_cast<double>(bins[0] - bins[-1]);
            top += moved * slope, bottom_sum += slope * slope;
        }
        if (bottom_sum > 0) square += std::pow(top / bottom_sum, 2), ++count;
    }
    EXPECT_GT(count, 100);
    EXPECT_NEAR(std::sqrt(square / count), 0.3, 0.08);
}

TEST(ImperfectionsTest, RejectsImpossibleConfigurationsWithTheReason) {
    const ImperfectionsConfig gains{.gain_error_db = 1};
    EXPECT_THAT(test::countRefusals(withErrors(imperfectFan(), gains)), IsEmpty());
    SonarConfig boxes = withErrors(imperfectFan(), gains);
    boxes.beam_pattern.reset();
    EXPECT_THAT(test::countRefusals(boxes),
                ElementsAre("imperfections: needs beam_pattern.receive.azimuth, whose aperture the elements fill"));
    boxes.imperfections = ImperfectionsConfig{.dead_beams = {3}};
    EXPECT_THAT(test::countRefusals(boxes), IsEmpty()) << "beams need no pattern";
    EXPECT_THAT(test::countRefusals(withErrors(imperfectFan(), {.dead_beams = {0, 41}})),
                ElementsAre("imperfections.dead_beams[1]: is 41; there are 41 beams, 0 to 40"));
    EXPECT_THAT(test::countRefusals(withErrors(imperfectFan(), {.dead_elements = {64}})),
                ElementsAre("imperfections.dead_elements[0]: is 64; there are 64 elements, 0 to 63"));
    EXPECT_THAT(test::countRefusals(withErrors(imperfectFan(), {.dead_element_share = 1})),
                ElementsAre("imperfections: leaves none of 64 elements alive"));
    EXPECT_THAT(test::countRefusals(withErrors(imperfectFan(), {.dead_beam_share = 1})),
                ElementsAre("imperfections: leaves none of 41 beams alive"));
    SonarConfig measured = withErrors(imperfectFan(), gains);
    measured.beam_pattern->receive.azimuth = acoustics::BeamLaw{};
    measured.beam_pattern->receive.azimuth->file = "pattern.csv";
    EXPECT_THAT(test::countRefusals(measured), testing::Contains(HasSubstr("which has its device's errors")));
    SonarConfig gaussian = withErrors(imperfectFan(Weighting::Gaussian), {.focus_m = 3});
    gaussian.beam_pattern->receive.azimuth->aperture_m.reset();
    gaussian.beam_pattern->receive.azimuth->width_deg = 2;
    EXPECT_THAT(test::countRefusals(gaussian), ElementsAre(HasSubstr("imperfections.focus_m: needs a weighted line")));
    SonarConfig toneless = withErrors(imperfectFan(), {.focus_m = 3});
    toneless.frequency_khz.reset();
    toneless.beam_pattern->receive.azimuth->aperture_m.reset();
    toneless.beam_pattern->receive.azimuth->width_deg = 2;
    EXPECT_THAT(test::countRefusals(toneless),
                ElementsAre("imperfections.focus_m: is given without frequency_khz, which it needs"));
    SonarConfig published = withErrors(imperfectFan(), {.dead_beams = {1}});
    published.beam_pattern.reset();
    published.model = Model::Cerqueira2017;
    EXPECT_THAT(test::countRefusals(published),
                ElementsAre("imperfections: is given with model: cerqueira2017; it belongs to physical"));
    SonarConfig elements = withErrors(imperfectFan(), {.elements = 20, .gain_error_db = 1, .focus_m = 3});
    elements.beam_geometry = BeamGeometry::Conical;
    elements.speckle.emplace().coherent = true;
    elements.elements.emplace();
    EXPECT_THAT(test::countRefusals(elements), ElementsAre(HasSubstr("whose signals are those of the far field"),
                                                           HasSubstr("their number is that of `elements`")));
}

/** A target in each of the first and the last beam leaks across the seam, for fans and tables of any order. */
TEST(ImperfectionsTest, BeamsAcrossTheSeamOfARingLeakIntoEachOther) {
    std::mt19937 random(4);
    for (int trial = 0; trial < 6; ++trial) {
        SonarConfig config = test::getSonar({.beams = 36, .width_deg = 360, .height_deg = 20, .bins = 200, .rows = 8});
        config.visibility = Visibility::Cpu;
        config.imperfections.emplace().crosstalk_db = -20;
        if (trial % 3 > 0) {
            config.field_of_view_deg.reset();
            config.beam_width_deg = trial % 3 == 1 ? 10 : 6;
            for (int k = 0; k < 36; ++k) config.bearings_deg.push_back(std::remainder(-175 + 10 * k + 1000, 360));
            std::ranges::shuffle(config.bearings_deg, random);
        }
        for (const double azimuth_deg : {175.0, -175.0, 5.0}) {
            types::Snapshot snapshot = test::makeSnapshot(test::openWater());
            const double azimuth = config.bearings_deg.empty() ? radians(azimuth_deg) : radians(config.bearings_deg[7]);
            snapshot.targets = {{10.05 * glm::dvec3(std::cos(azimuth), std::sin(azimuth), 0), 0}};
            const types::Sonar ping = imperfectPing(config, snapshot);
            size_t own = 0, leaks = 0;
            for (size_t beam = 0; beam < 36; ++beam) {
                const double level = double{ping.bins[beam * 200 + 100]} * std::pow(10.05, 4);
                const double off = std::abs(std::remainder(ping.bearings[beam].rad - azimuth, 2 * pi));
                EXPECT_NEAR(level, off < radians(1) ? 1 : off < radians(11) ? 0.01 : 0, 1e-5) << beam;
                own += off < radians(1) ? 1 : 0;
                leaks += off >= radians(1) && off < radians(11) ? 1 : 0;
            }
            EXPECT_EQ(own, 1u);
            EXPECT_EQ(leaks, 2u);
        }
    }
}

}  // namespace
}  // namespace insonify::sonar
