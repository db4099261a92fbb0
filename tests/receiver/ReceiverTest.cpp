#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>

#include "components/receiver/Receiver.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Refused.hpp"
#include "types/geometry/Geometry.hpp"
#include "types/geometry/VectorMath.hpp"

namespace insonify::receiver {
namespace {

using testing::Each;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float maximum = std::numeric_limits<float>::max();

types::Sonar received(const ReceiverConfig& config, const types::Sonar& intensities) {
    types::Sonar ping;
    Receiver(config).receive(intensities, ping);
    return ping;
}

/** Returns one beam with these intensities. */
types::Sonar getBeam(const std::vector<float>& bins) {
    types::Sonar ping = test::makePing(1, static_cast<uint32_t>(bins.size()));
    ping.bins = bins;
    return ping;
}

ReceiverConfig giving(Output output) {
    ReceiverConfig config;
    config.output = output;
    return config;
}

ReceiverConfig coding(const CodeConfig& code) {
    ReceiverConfig config = giving(Output::Code);
    config.code = code;
    return config;
}

TEST(ReceiverTest, NeutralValuesGiveTheSameBins) {
    types::Sonar ping = test::makePing(3, 200);
    for (size_t i = 0; i < ping.bins.size(); ++i) ping.bins[i] = static_cast<float>(i) * 1.37e-9f;
    ReceiverConfig neutral;
    neutral.tvg.emplace();
    neutral.blanking.emplace();
    EXPECT_EQ(received(neutral, ping).bins, ping.bins);
    EXPECT_TRUE(Receiver({}).isNeutral());
    EXPECT_FALSE(Receiver(neutral).isNeutral());
}

TEST(ReceiverTest, TheGainOfABinIsThatOfItsMiddle) {
    ReceiverConfig config;
    config.tvg = TvgConfig{.log_coefficient = 40, .db_per_m = 0.5, .max_db = 70};
    config.gain_db = 3;
    const types::Sonar ping = received(config, test::makePing(2, 400, 1e-6f));
    for (size_t k = 0; k < 400; ++k) {
        const double r = 0.1 * (static_cast<double>(k) + 0.5);
        const double gain = std::min(40 * std::log10(r) + r, 70.0) + 3;
        EXPECT_NEAR(ping.bins[400 + k] / (1e-6 * std::pow(10, gain / 10)), 1, 1e-6) << r;
    }
}

TEST(ReceiverTest, TheGainIsClampedAtItsMax) {
    const TvgConfig tvg{.log_coefficient = 40, .db_per_m = 0.5, .max_db = 100};
    EXPECT_DOUBLE_EQ(tvgDb(tvg, 1), 1);
    EXPECT_DOUBLE_EQ(tvgDb(tvg, 10), 50);
    EXPECT_DOUBLE_EQ(tvgDb(tvg, 100), 100);
    EXPECT_DOUBLE_EQ(unclampedTvgDb(tvg, 100), 180);
    EXPECT_NEAR(unclampedTvgDb(tvg, *clampRange(tvg, 50)), 100, 1e-9);
    EXPECT_FALSE(clampRange(tvg, 20));
}

TEST(ReceiverTest, NoBinOverflowsAndNoEchoStaysZero) {
    ReceiverConfig config;
    config.tvg = TvgConfig{.log_coefficient = 0, .db_per_m = 1000, .max_db = 1000};
    const auto bins = received(config, getBeam({0, 1e-30f, 1, nan, std::numeric_limits<float>::infinity()})).bins;
    EXPECT_EQ(bins[0], 0);
    EXPECT_EQ(bins[2], maximum);
    EXPECT_TRUE(std::isnan(bins[3])) << "unknown stays unknown";
    EXPECT_EQ(bins[4], maximum);
    EXPECT_TRUE(std::isfinite(bins[1]));
}

TEST(ReceiverTest, BinsNearerThanTheBlankingAreSilentInEveryOutput) {
    for (const auto& [output, silence] : {std::pair(Output::Intensity, 0.0f),
                                          {Output::Amplitude, 0.0f},
                                          {Output::LevelDb, -3000.0f},
                                          {Output::Code, 0.0f}}) {
        ReceiverConfig config = giving(output);
        config.blanking = BlankingConfig{0.35};
        types::Sonar ping = test::makePing(2, 10);
        ping.bins[1] = nan;
        const auto bins = received(config, ping).bins;
        for (size_t k = 0; k < 4; ++k) EXPECT_EQ(bins[k], silence) << "the bin of 0.3 to 0.4 m begins before";
        for (size_t k = 4; k < 10; ++k) EXPECT_NE(bins[10 + k], silence);
        config.blanking->range_min = 0.3;
        EXPECT_NE(received(config, ping).bins[3], silence) << "a bin that begins at range_min is not silent";
    }
}

TEST(ReceiverTest, AmplitudeIsTheRootOfIntensity) {
    EXPECT_EQ(received(giving(Output::Amplitude), getBeam({0, 4, 0.25f})).bins, (std::vector<float>{0, 2, 0.5f}));
}

TEST(ReceiverTest, LevelsAreDecibelsOverTheWholeRangeOfAFloat) {
    const std::vector<float> intensities = {0, 1, 1e-10f, 3e38f, 1e-38f, 1e-44f, 0.70710678f, 1.41421356f, 0.99999994f};
    const auto levels = received(giving(Output::LevelDb), getBeam(intensities)).bins;
    EXPECT_EQ(levels[0], -3000);
    EXPECT_EQ(levels[1], 0);
    for (size_t i = 1; i < intensities.size(); ++i)
        EXPECT_NEAR(levels[i], 10 * std::log10(static_cast<double>(intensities[i])), 4e-5) << intensities[i];
    ReceiverConfig config = giving(Output::LevelDb);
    config.source_level_db = 210;
    EXPECT_EQ(received(config, getBeam(intensities)).bins, levels) << "relative to the source";
    config.output = Output::ReceivedLevelDb;
    EXPECT_NEAR(received(config, getBeam(intensities)).bins[2], 110, 1e-4);
    EXPECT_TRUE(std::isnan(received(config, getBeam({nan})).bins[0]));
}

TEST(ReceiverTest, TheVectorisedLogarithmIsRightToTheLastDigitsOfALevel) {
    double worst = 0;
    for (float x = 1.2e-38f; x < 3e38f; x *= 1.00173f)
        worst = std::max(worst, std::abs(types::decibels(x) - 10 * std::log10(static_cast<double>(x))));
    EXPECT_LT(worst, 4e-5);
}

TEST(ReceiverTest, CodesFollowTheirLawBetweenTheirEnds) {
    const std::vector<float> intensities = {0, 0.25f, 1, 4, nan, 3e-3f};
    EXPECT_EQ(received(coding({.bits = 8, .law = CodeLaw::Linear}), getBeam(intensities)).bins,
              (std::vector<float>{0, 64, 255, 255, 0, 1}));
    EXPECT_EQ(received(coding({.bits = 8, .law = CodeLaw::Sqrt}), getBeam(intensities)).bins,
              (std::vector<float>{0, 128, 255, 255, 0, 14}));
    EXPECT_EQ(received(coding({.bits = 8, .law = CodeLaw::Log, .dynamic_range_db = 60}), getBeam(intensities)).bins,
              (std::vector<float>{0, 229, 255, 255, 0, 148}));
    EXPECT_EQ(received(coding({.bits = 16, .law = CodeLaw::Log, .dynamic_range_db = 60}), getBeam(intensities)).bins,
              (std::vector<float>{0, 58959, 65535, 65535, 0, 37979}));
}

TEST(ReceiverTest, CodesHaveAnyWidthFromEightToSixteenBits) {
    for (int bits = 8; bits <= 16; ++bits) {
        const auto full = static_cast<float>((1 << bits) - 1);
        EXPECT_EQ(received(coding({.bits = bits, .law = CodeLaw::Sqrt}), getBeam({0, 0.25f, 1, 4, nan})).bins,
                  (std::vector<float>{0, 0.5f * (full + 1), full, full, 0}));
    }
}

TEST(ReceiverTest, GammaIsThePowerOfACode) {
    const std::vector<float> intensities = {0, 0.0625f, 0.25f, 1, 4, nan};
    EXPECT_EQ(received(coding({.law = CodeLaw::Sqrt, .gamma = 0.5}), getBeam(intensities)).bins,
              (std::vector<float>{0, 128, 180, 255, 255, 0}));
    EXPECT_EQ(received(coding({.law = CodeLaw::Linear, .gamma = 0.25}), getBeam(intensities)).bins,
              (std::vector<float>{0, 128, 180, 255, 255, 0}));
    EXPECT_EQ(received(coding({.law = CodeLaw::Linear, .gamma = 2}), getBeam(intensities)).bins,
              (std::vector<float>{0, 1, 16, 255, 255, 0}));
    EXPECT_EQ(received(coding({.law = CodeLaw::Sqrt, .gamma = 1}), getBeam(intensities)).bins,
              received(coding({.law = CodeLaw::Sqrt}), getBeam(intensities)).bins);
}

TEST(ReceiverTest, FullScaleIsTheLevelOfTheMaxCodeWithAllGain) {
    for (const CodeLaw law : {CodeLaw::Linear, CodeLaw::Sqrt, CodeLaw::Log}) {
        ReceiverConfig config = coding({.law = law, .full_scale_db = -20});
        config.gain_db = 10;
        const auto bins = received(config, getBeam({0.001f, 0.0009f})).bins;
        EXPECT_EQ(bins[0], 255);
        EXPECT_LT(bins[1], 255);
    }
}

TEST(ReceiverTest, RejectsContradictionsAndReportsUnusedConfiguration) {
    EXPECT_THAT(test::countRefusals(CodeConfig{.law = CodeLaw::Log, .gamma = 0.5}),
                testing::ElementsAre("gamma: is given with law log; it bends law linear and sqrt"));
    ReceiverConfig config = giving(Output::LevelDb);
    config.brightness.emplace();
    config.tvg.emplace();
    EXPECT_THAT(test::countRefusals(config),
                testing::ElementsAre("brightness: is given with tvg; it compensates for spreading itself",
                                     "brightness: is given with another output; it scales output: intensity"));
    config = {};
    config.code.emplace();
    EXPECT_THAT(Receiver(config).notices(), testing::ElementsAre("code is configured, but only output: code uses it"));
}

/** A typo in one of them turns a vehicle's picture white or black. */
TEST(ReceiverTest, ValuesThatNoReceiverHasAreWarnings) {
    struct Case {
        const char* name;
        std::function<double&(ReceiverConfig&)> value;
        double usual, typo;
    };
    const Case cases[] = {
        {"gain_db", [](auto& c) -> double& { return c.gain_db; }, 30, 300},
        {"gain_db", [](auto& c) -> double& { return c.gain_db; }, -30, -300},
        {"tvg.log_coefficient", [](auto& c) -> double& { return c.tvg.emplace().log_coefficient; }, 40, 400},
        {"tvg.db_per_m", [](auto& c) -> double& { return c.tvg.emplace().db_per_m; }, 0.21, 21},
        {"tvg.max_db", [](auto& c) -> double& { return c.tvg.emplace().max_db; }, 110, 1000},
        {"code.full_scale_db",
         [](auto& c) -> double& {
             c.output = Output::Code;
             return c.code.emplace().full_scale_db;
         },
         -58, -580},
        {"automatic_gain.target_db", [](auto& c) -> double& { return c.automatic_gain.emplace().target_db; }, -20, 200},
        {"automatic_gain.max_db", [](auto& c) -> double& { return c.automatic_gain.emplace().max_db; }, 40, 400},
        {"saturation_db", [](auto& c) -> double& { return c.saturation_db.emplace(); }, -10, -1000},
        {"source_level_db",
         [](auto& c) -> double& {
             c.output = Output::ReceivedLevelDb;
             return c.source_level_db;
         },
         220, -220},
    };
    for (const Case& each : cases) {
        ReceiverConfig config;
        each.value(config) = each.usual;
        EXPECT_THAT(Receiver(config).notices(), testing::IsEmpty()) << each.name;
        each.value(config) = each.typo;
        EXPECT_THAT(test::countRefusals(config), testing::IsEmpty()) << each.name;
        const types::Notices notices = Receiver(config).notices();
        ASSERT_EQ(notices.size(), 1u) << each.name;
        EXPECT_EQ(notices[0].kind, types::Notice::Kind::Warning);
        EXPECT_THAT(notices[0].text, testing::StartsWith(std::string(each.name) + " is ")) << each.typo;
    }
}

TEST(ReceiverTest, ABrightnessOfOneHalfShowsACellOfMediumSandFaceOnAsOneAtEveryRange) {
    ReceiverConfig config;
    types::Sonar sand = test::makePing(1, 300);
    for (size_t k = 0; k < 300; ++k) {
        const double r = 0.1 * (static_cast<double>(k) + 0.5);
        const double cell = types::radians(2) * 0.1 / r;  // [sr]
        sand.bins[k] = static_cast<float>(std::pow(10, types::Material{}.lambert_db / 10.0) * cell / (r * r));
    }
    for (const double gain : {0.5, 0.25, 0.0}) {
        config.brightness = BrightnessConfig{gain, Model::Physical};
        for (const float bin : received(config, sand).bins) EXPECT_NEAR(bin, 2 * gain, 1e-5);
    }
    config.brightness->gain = 0.75;
    EXPECT_THAT(received(config, sand).bins, Each(1)) << "brighter than the display";
}

TEST(ReceiverTest, ABrightnessOfPublishedPingsIsTwiceTheGainAndAtMostOne) {
    ReceiverConfig config;
    config.brightness = BrightnessConfig{0.75, Model::Cerqueira2017};
    const auto bins = received(config, getBeam({0, 0.1f, 0.6f, 0.9f})).bins;
    EXPECT_EQ(bins[0], 0);
    EXPECT_NEAR(bins[1], 0.15, 1e-7);
    EXPECT_NEAR(bins[2], 0.9, 1e-7);
    EXPECT_EQ(bins[3], 1);
}

TEST(ReceiverTest, APingOfAnotherShapeOrRangeHasItsOwnGain) {
    ReceiverConfig config;
    config.tvg = TvgConfig{.log_coefficient = 20, .db_per_m = 0, .max_db = 100};
    Receiver receiver(config);
    types::Sonar ping, first = test::makePing(2, 100), longer = test::makePing(1, 50);
    longer.bin_duration.microseconds = 1000;
    receiver.receive(first, ping);
    const std::vector<float> before = ping.bins;
    receiver.receive(longer, ping);
    EXPECT_EQ(ping.bins, received(config, longer).bins);
    receiver.receive(first, ping);
    EXPECT_EQ(ping.bins, before);
}

TEST(ReceiverTest, KeepsEverythingExceptTheBins) {
    types::Sonar ping = test::makePing(2, 3);
    ping.timestamps = {{1}, {2}};
    ping.beam_height = types::Angle{0.2};
    ping.bearings = {types::Angle{0.3}, types::Angle{-0.3}};
    const types::Sonar out = received(giving(Output::LevelDb), ping);
    EXPECT_EQ(out.time, ping.time);
    EXPECT_EQ(out.timestamps, ping.timestamps);
    EXPECT_EQ(out.bin_duration, ping.bin_duration);
    EXPECT_EQ(out.beam_width.rad, ping.beam_width.rad);
    EXPECT_EQ(out.beam_height.rad, 0.2);
    EXPECT_EQ(out.bearings[1].rad, -0.3);
    EXPECT_EQ(out.speed_of_sound, 1000);
    EXPECT_EQ(out.bin_count, 3u);
    EXPECT_EQ(out.beam_count, 2u);
}

TEST(ReceiverTest, GainAndBlankingAreAtExactRanges) {
    ReceiverConfig config;
    config.tvg.emplace().log_coefficient = 40;
    config.blanking.emplace().range_min = 0.5;
    types::Sonar ping, out;
    ping.setBins(0.001, 1500);  // 0.67 us
    ping.resize(1000, 1);
    ping.bins.assign(1000, 1);
    Receiver(config).receive(ping, out);
    EXPECT_EQ(out.bins[499], 0);
    EXPECT_NEAR(10 * std::log10(out.bins[500]), 40 * std::log10(0.5005), 1e-4);
    EXPECT_NEAR(10 * std::log10(out.bins[750]), 40 * std::log10(0.7505), 1e-4);
    EXPECT_EQ(out.binWidth(), 0.001);
}

}  // namespace
}  // namespace insonify::receiver
