// Fits to simulated recordings of sonars with random properties.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "components/study/Probe.hpp"
#include "components/study/likeness/Likeness.hpp"
#include "tests/study/FitBench.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::study {
namespace {

constexpr int beams = 128, bins = 512;
constexpr double range = 12, speed_of_sound = 1500, fan_deg = 60;

/** Returns a user's initial values, which are arbitrary. */
FitChain guess() {
    FitChain chain;
    chain.sonar.range = range;
    chain.sonar.bin_count = bins;
    chain.sonar.beam_count = beams;
    chain.sonar.field_of_view_deg = fan_deg;
    chain.sonar.beam_height_deg = 40;
    chain.sonar.speed_of_sound = speed_of_sound;
    chain.sonar.frequency_khz = 450;
    chain.sonar.absorption.emplace().db_per_m = 0.1;
    setSamples(chain.sonar, 128, 1);
    chain.snapshot = lookingAt(floorAt(-2), {}, 0, 0.45);
    chain.receiver.output = receiver::Output::Code;
    chain.receiver.code.emplace() = {.bits = 8, .law = receiver::CodeLaw::Sqrt, .gamma = 0.5};
    chain.receiver.tvg.emplace().log_coefficient = 20;
    return chain;
}

/** A sonar with random properties over the same floor. */
struct Truth {
    FitChain chain = guess();
    double beam_width_deg, pulse_m, noise_db, density, log_coefficient, db_per_m;

    explicit Truth(uint32_t seed) {
        Draws draws(seed);
        const auto between = [&](double low, double high) { return draws.between(low, high); };
        beam_width_deg = between(0.6, 1.3);
        pulse_m = between(1.2, 2.5) * range / bins;
        noise_db = between(-92, -84);
        density = between(250, 600);
        log_coefficient = between(20, 40);
        db_per_m = between(0.05, 0.3);
        sonar::SonarConfig& sonar = chain.sonar;
        sonar.absorption->db_per_m = between(0.06, 0.14);
        auto& azimuth = sonar.beam_pattern.emplace().receive.azimuth.emplace();
        azimuth.weighting = acoustics::Weighting::Taylor;
        azimuth.width_deg = beam_width_deg;
        auto& pulse = sonar.pulse.emplace();
        pulse.bandwidth_khz = 10;
        *pulse.bandwidth_khz *= acoustics::Pulse(pulse, speed_of_sound).resolution() / pulse_m;
        sonar.speckle.emplace().coherent = true;
        sonar.speckle->scatterers_per_m2 = density;
        chain.noise.ambient.emplace().level_db = noise_db;
        chain.receiver.tvg->log_coefficient = log_coefficient;
        chain.receiver.tvg->db_per_m = db_per_m;
        chain.receiver.code->full_scale_db = -20;
        chain.receiver.code->full_scale_db += loudestLevelDb(chain) + 29 + between(-3, 3);
    }
    /** Returns pings from three places. */
    std::vector<CodedPing> recorded() const {
        std::vector<CodedPing> pings = simulatedPings(chain, 3);
        for (CodedPing& ping : pings) ping.frequency_khz = *chain.sonar.frequency_khz;
        return pings;
    }
};

class FitRecoveryTest : public testing::TestWithParam<uint32_t> {};

TEST_P(FitRecoveryTest, FindsThePropertiesOfASimulatedSonar) {
    const Truth truth(GetParam());
    const RecordingFit fit = fitRecording(truth.recorded(), guess(), false, [](const std::string&) {});
    expectFound(fit, "beam width", truth.beam_width_deg, 0.05 * truth.beam_width_deg);
    if (!expectTruth(fit, truth, range)) {
        EXPECT_GT(GetParam(), 4);
    }
}

/** Returns the deviation of the grey levels of columns [from, to) of a picture. */
double deviation(const types::Image& image, size_t from, size_t to) {
    double sum = 0, squares = 0, count = 0;
    for (size_t y = 0; y < image.size.height; ++y)
        for (size_t x = from; x < to; ++x) {
            const double grey = image.image[y * image.row_size + x];
            ++count, sum += grey, squares += grey * grey;
        }
    return std::sqrt(squares / count - sum * sum / count / count);
}

TEST(FitReportTest, ThePageHasBothPicturesAndEveryFindingAndTheDeploymentEverySetting) {
    const Truth truth(5);
    const CodedPing recorded = truth.recorded().front();
    RecordingFit fit = fitRecording({recorded}, guess(), false, [](const std::string&) {});
    fit.levels.pitch_deg.emplace(), fit.levels.height_m.emplace(), fit.levels.elevation_deg.emplace();
    fit.chain.sonar.beam_pattern->transmit.elevation.emplace();
    const types::Image both = drawFans({recorded, fit.simulated_pings.front()});
    EXPECT_GT(deviation(both, 0, both.size.width / 2), 10);
    EXPECT_GT(deviation(both, both.size.width / 2, both.size.width), 10);
    const std::string page = makePage(fit, {recorded}, "picture.png");
    for (const Finding& finding : fit.findings) EXPECT_NE(page.find("<td>" + finding.name), std::string::npos);
    EXPECT_NE(page.find("src=\"picture.png\""), std::string::npos);
    std::set<std::string> paths;
    for (const FitSetting& setting :
         getSettings(fit, {.vehicle = "v", .scene = "a", .sonar = "b", .noise = "c", .receiver = "d"}))
        EXPECT_TRUE(paths.insert(setting.path).second) << setting.path << " is set twice";
    for (const char* path : {"a.mount.pitch_deg", "b.pulse", "b.speckle", "c.ambient", "d.code", "d.tvg.db_per_m"})
        EXPECT_TRUE(paths.contains(path)) << path;
}

TEST(FitSpeckleTest, MeasuresSidelobesOfIsolatedTargetsButNotOfSpeckle) {
    Truth truth(6);
    truth.chain.sonar.beam_pattern->receive.azimuth->sidelobe_db = -25;
    truth.chain.noise.ambient->level_db = -140;
    truth.chain.receiver.code->law = receiver::CodeLaw::Log;
    truth.chain.receiver.code->gamma = 1;
    truth.chain.receiver.code->bits = 16;
    truth.chain.receiver.code->dynamic_range_db = 200;
    const double width_beams = truth.beam_width_deg / (fan_deg / beams);
    EXPECT_FALSE(sidelobes(simulatedPings(truth.chain, 1), width_beams).isKnown()) << "speckle is not a target";
    for (const double bearing : {-0.2, 0.0, 0.25})
        truth.chain.snapshot.targets.push_back(
            {.position = 1.6 * glm::dvec3(std::cos(bearing) * std::cos(0.45), std::sin(bearing),
                                          -std::cos(bearing) * std::sin(0.45)),
             .strength_db = -30});
    truth.chain.receiver.code->full_scale_db += 60;
    const Measured found = sidelobes(simulatedPings(truth.chain, 1), width_beams);
    ASSERT_TRUE(found.isKnown());
    EXPECT_NEAR(found.value, -25, 1.5);
}

TEST(RecordingFitTest, RefusesUnusableRecordingsWithAReason) {
    const auto refusal = [](const std::vector<CodedPing>& recorded, FitChain chain) -> std::string {
        return test::computeError<types::ConfigError>(
            [&] { fitRecording(recorded, std::move(chain), false, [](const std::string&) {}); });
    };
    CodedPing ping = simulatedPings(guess(), 1).front();
    FitChain without = guess();
    without.sonar.frequency_khz.reset();
    EXPECT_NE(refusal({ping}, without).find("states no frequency"), std::string::npos);
    FitChain empty = guess();
    empty.snapshot = lookingAt(floorAt(-500), {}, 0, 0.45);
    EXPECT_NE(refusal({ping}, empty).find("no echo in the range"), std::string::npos);
    CodedPing odd = ping;
    odd.bits = 24;
    EXPECT_NE(refusal({odd}, guess()).find("codes of 24 bits"), std::string::npos);
    ping.is_waterfall = true;
    EXPECT_NE(refusal({ping}, guess()).find("side-scan"), std::string::npos);
    EXPECT_NE(refusal({}, guess()).find("no ping"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FitRecoveryTest, testing::ValuesIn(fitSeeds({2, 3, 4, 15})));

}  // namespace
}  // namespace insonify::study
