// Gain that follows the level along a ping, and saturation.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "components/receiver/Receiver.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::receiver {
namespace {

/** Returns three beams with these intensities as their mean. */
types::Sonar getBeams(const std::vector<float>& bins) {
    types::Sonar ping = test::makePing(3, static_cast<uint32_t>(bins.size()));
    for (size_t i = 0; i < ping.bins.size(); ++i)
        ping.bins[i] = bins[i % bins.size()] * (i < bins.size() ? 0.5f : i < 2 * bins.size() ? 1.0f : 1.5f);
    return ping;
}

std::vector<float> heldBins(const ReceiverConfig& config, const types::Sonar& ping) {
    types::Sonar out;
    Receiver(config).receive(ping, out);
    return out.bins;
}

ReceiverConfig following(Output output = Output::LevelDb) {
    ReceiverConfig config;
    config.output = output;
    config.automatic_gain = AutomaticGainConfig{.target_db = -20, .attack_ms = 2, .release_ms = 6, .max_db = 80};
    return config;
}

double computeLevel(const std::vector<float>& bins, size_t count, size_t bin) {
    return static_cast<double>(bins[count + bin]);  // of the beam in the middle
}

TEST(AutomaticGainTest, ASteadyLevelReachesTheTarget) {
    for (const float level : {1e-6f, 1e-2f, 1.0f, 1e5f}) {
        const std::vector<float> bins = heldBins(following(), getBeams(std::vector<float>(200, level)));
        for (size_t bin = 0; bin < 200; ++bin) EXPECT_NEAR(computeLevel(bins, 200, bin), -20, 1e-3) << level;
        EXPECT_NEAR(static_cast<double>(bins[0]), -20 - 10 * std::log10(2), 1e-3) << "beams keep their differences";
    }
}

TEST(AutomaticGainTest, AJumpIsFollowedInTheTimesOfAttackAndRelease) {
    std::vector<float> steps(600, 1e-4f);
    std::fill(steps.begin() + 200, steps.begin() + 400, 1.0f);
    const types::Sonar ping = getBeams(steps);
    const double bin_ms = 2e-3 * static_cast<double>(ping.bin_duration.microseconds);  // there and back
    const std::vector<float> bins = heldBins(following(), ping);
    for (size_t k = 0; k < 200; ++k) {
        const double up = 1 - (1 - 1e-4) * std::exp(-static_cast<double>(k + 1) * bin_ms / 2);
        EXPECT_NEAR(computeLevel(bins, 600, 200 + k), -20 - 10 * std::log10(up), 0.01) << k;
        const double top = 1 - (1 - 1e-4) * std::exp(-200 * bin_ms / 2);
        const double down = 1e-4 + (top - 1e-4) * std::exp(-static_cast<double>(k + 1) * bin_ms / 6);
        EXPECT_NEAR(computeLevel(bins, 600, 400 + k), -20 - 40 - 10 * std::log10(down), 0.01) << k;
    }
}

TEST(AutomaticGainTest, TheGainIsBoundedAndEmptyPingsStayEmpty) {
    ReceiverConfig config = following(Output::Intensity);
    config.automatic_gain->max_db = 10;
    for (const float bin : heldBins(config, getBeams(std::vector<float>(50, 1e-9f)))) EXPECT_LE(bin, 1.6e-8f);
    for (const float bin : heldBins(config, getBeams(std::vector<float>(50, 1e6f)))) EXPECT_GE(bin, 4.9e4f);
    for (const float bin : heldBins(config, getBeams(std::vector<float>(50, 0)))) EXPECT_EQ(bin, 0);
    std::vector<float> strange(50, 1.0f);
    strange[7] = std::numeric_limits<float>::quiet_NaN();
    strange[9] = std::numeric_limits<float>::max();
    const std::vector<float> bins = heldBins(config, getBeams(strange));
    EXPECT_TRUE(std::isnan(bins[7]));
    for (size_t i = 0; i < bins.size(); ++i) EXPECT_TRUE(i % 50 == 7 || std::isfinite(bins[i])) << i;
}

TEST(AutomaticGainTest, TheGainOfAPingDoesNotDependOnEarlierPings) {
    Receiver receiver(following());
    types::Sonar first, between, again;
    receiver.receive(getBeams(std::vector<float>(100, 3)), first);
    receiver.receive(getBeams(std::vector<float>(100, 3e9f)), between);
    receiver.receive(getBeams(std::vector<float>(100, 3)), again);
    EXPECT_EQ(first.bins, again.bins);
}

TEST(AutomaticGainTest, CodesReachTheTargetBelowFullScale) {
    ReceiverConfig config = following(Output::Code);
    config.code = CodeConfig{.bits = 16, .law = CodeLaw::Log, .full_scale_db = -10, .dynamic_range_db = 60};
    const std::vector<float> bins = heldBins(config, getBeams(std::vector<float>(40, 7e-5f)));
    EXPECT_NEAR(computeLevel(bins, 40, 20), 65535 * (1 - 10.0 / 60), 2);
}

TEST(AutomaticGainTest, NoBinExceedsTheSaturation) {
    const types::Sonar ping = getBeams({1e-6f, 1e-2f, 1, 1e3f});
    ReceiverConfig config;
    config.saturation_db = -10;
    config.gain_db = 3;
    const float gain = static_cast<float>(std::pow(10, 0.3));
    std::vector<float> bins = heldBins(config, ping);
    for (size_t i = 0; i < bins.size(); ++i) EXPECT_FLOAT_EQ(bins[i], std::min(0.1f, gain * ping.bins[i]));
    config.output = Output::LevelDb;
    bins = heldBins(config, ping);
    for (size_t i = 0; i < bins.size(); ++i)
        EXPECT_NEAR(bins[i], std::min(-10.0, 3 + 10 * std::log10(static_cast<double>(ping.bins[i]))), 1e-3);
    config.output = Output::Code;
    config.code = CodeConfig{.bits = 8, .law = CodeLaw::Linear, .full_scale_db = 0};
    EXPECT_EQ(heldBins(config, ping)[3], std::round(0.1f * 255)) << "below the max code";
    EXPECT_FALSE(Receiver(config).isNeutral());
}

TEST(AutomaticGainTest, BrightnessExcludesAutomaticGainAndSaturation) {
    ReceiverConfig config;
    config.brightness.emplace();
    config.automatic_gain.emplace();
    config.saturation_db = 0;
    EXPECT_THAT(test::countRefusals(config),
                testing::ElementsAre(testing::StartsWith("automatic_gain: "), testing::StartsWith("saturation_db: ")));
}

}  // namespace
}  // namespace insonify::receiver
