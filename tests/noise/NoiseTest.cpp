#include <gtest/gtest.h>

#include <limits>

#include "tests/noise/Distributions.hpp"

namespace insonify::noise {
namespace {

TEST(NoiseTest, TheNoiseOfTheSeaIsFiniteAtAnyLevel) {
    NoiseConfig config;
    config.ambient.emplace();
    config.ambient->wind_m_s = 100;
    config.ambient->bandwidth_khz = 1e4;
    config.ambient->frequency_khz = 1e-3;
    config.ambient->source_level_db = -300;
    for (const float bin : makeNoisy(config, makePing(2, 300, 0)).bins) EXPECT_TRUE(std::isfinite(bin) && bin > 0);
}

TEST(NoiseTest, AdditiveNoiseDoesNotFollowTheSpeckle) {
    const types::Sonar added = makeNoisy(background(0), makePing(1, 4096, 0));
    const types::Sonar speckle = makeNoisy(rayleigh(), makePing(1, 4096));
    EXPECT_LT(std::abs(correlation(added.bins.data(), speckle.bins.data(), 4096)), 4 / std::sqrt(4096.0));
}

TEST(NoiseTest, TheSameSeedAndPingGiveTheSameNoise) {
    for (const uint64_t seed : {uint64_t{0}, uint64_t{7}, std::numeric_limits<uint64_t>::max()}) {
        const types::Sonar clean = makePing(8, 300);
        EXPECT_EQ(makeNoisy(rayleigh(seed), clean).bins, makeNoisy(rayleigh(seed), clean).bins) << seed;
    }
}

TEST(NoiseTest, BeamsPingsSeedsAndBinsAreUncorrelated) {
    constexpr size_t count = 4096;
    const types::Sonar one = makeNoisy(rayleigh(0), makePing(2, count + 1));
    const types::Sonar later = makeNoisy(rayleigh(0), makePing(2, count + 1, 1, 1000001));
    const types::Sonar other = makeNoisy(rayleigh(std::numeric_limits<uint64_t>::max()), makePing(2, count + 1));
    const types::Sonar high_word = makeNoisy(rayleigh(uint64_t{1} << 32), makePing(2, count + 1));
    const float* bins = one.bins.data();
    const float* others[] = {bins + count + 1, bins + 1, later.bins.data(), other.bins.data(), high_word.bins.data()};
    for (const float* compared : others)
        EXPECT_LT(std::abs(correlation(bins, compared, count)), 4 / std::sqrt(static_cast<double>(count)));
}

TEST(NoiseTest, NoiseOfABinDoesNotDependOnTheNumberOfBeamsOrBins) {
    const types::Sonar small = makeNoisy(rayleigh(), makePing(3, 70)), large = makeNoisy(rayleigh(), makePing(5, 1000));
    for (size_t beam = 0; beam < 3; ++beam)
        for (size_t bin = 0; bin < 70; ++bin) EXPECT_EQ(small.bins[beam * 70 + bin], large.bins[beam * 1000 + bin]);
}

TEST(NoiseTest, NegativeFactorsAreClampedAndCounted) {
    types::Sonar noisy;
    const uint64_t clamped = Noise(gaussian(0.4, 10)).add(makePing(100, 100), noisy);
    EXPECT_NEAR(static_cast<double>(clamped) / 10000, normalCdf(-0.04), 0.02);
    EXPECT_GE(*std::min_element(noisy.bins.begin(), noisy.bins.end()), 0);
    EXPECT_EQ(clamped, static_cast<uint64_t>(std::count(noisy.bins.begin(), noisy.bins.end(), 0.0f)));
}

TEST(NoiseTest, NeutralValuesDoNotChangeThePing) {
    types::Sonar clean = makePing(4, 300);
    for (size_t i = 0; i < clean.bins.size(); ++i) clean.bins[i] = static_cast<float>(i) * 0.37f;
    for (const NoiseConfig& neutral : {NoiseConfig{}, gaussian(1, 0), background(-3000), withSea({}, -3000)})
        EXPECT_EQ(makeNoisy(neutral, clean).bins, clean.bins);
}

TEST(NoiseTest, UnknownBinsStayUnknownAndEmptyBinsStayEmpty) {
    types::Sonar clean = makePing(1, 10, 0);
    clean.bins[3] = std::numeric_limits<float>::quiet_NaN();
    for (const NoiseConfig& config :
         {rayleigh(), gamma(4), makeK(2), gaussian(0.4, 0.15), background(-20), withSea({}, -20)})
        EXPECT_TRUE(std::isnan(makeNoisy(config, clean).bins[3]));
    EXPECT_EQ(makeNoisy(rayleigh(), clean).bins[2], 0);
}

TEST(NoiseTest, KeepsEverythingExceptTheBins) {
    types::Sonar clean = makePing(2, 3);
    clean.timestamps = {{1}, {2}};
    clean.bin_duration = {33};
    clean.beam_width = types::Angle{0.1};
    clean.beam_height = types::Angle{0.2};
    clean.bearings = {types::Angle{0.3}, types::Angle{-0.3}};
    clean.speed_of_sound = 1480;
    const types::Sonar noisy = makeNoisy(rayleigh(), clean);
    EXPECT_EQ(noisy.time, clean.time);
    EXPECT_EQ(noisy.timestamps, clean.timestamps);
    EXPECT_EQ(noisy.bin_duration, clean.bin_duration);
    EXPECT_EQ(noisy.beam_width.rad, 0.1);
    EXPECT_EQ(noisy.beam_height.rad, 0.2);
    EXPECT_EQ(noisy.bearings[1].rad, -0.3);
    EXPECT_EQ(noisy.speed_of_sound, 1480);
    EXPECT_EQ(noisy.bin_count, 3u);
    EXPECT_EQ(noisy.beam_count, 2u);
}

}  // namespace
}  // namespace insonify::noise
