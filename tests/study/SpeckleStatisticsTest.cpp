// Statistics of speckle on fields with known answers, and on recordings of a device.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <filesystem>
#include <numbers>

#include "components/device/OculusRecording.hpp"
#include "components/noise/Noise.hpp"
#include "components/study/SpeckleStatistics.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Pings.hpp"
#include "types/text/Hash.hpp"

namespace insonify::study {
namespace {

constexpr uint32_t beams = 128, bins = 512;

types::Sonar speckled(const noise::SpeckleConfig& law, int64_t time = 1) {
    noise::NoiseConfig config;
    config.speckle = law;
    types::Sonar noisy;
    noise::Noise(config).add(test::makePing(beams, bins, 1, time), noisy);
    return noisy;
}

SpeckleFigures figuresOfLaw(const noise::SpeckleConfig& law) {
    return computeFigures(overMeans(speckled(law), test::makePing(beams, bins)));
}

/** Returns a complex Gaussian of unit mean square, the same for the same place. */
std::complex<double> gaussian(uint64_t seed, size_t a, size_t b) {
    const uint64_t word = types::hashed(seed, a, b);
    return std::polar(std::sqrt(-std::log(types::unit(word >> 32))),
                      2 * std::numbers::pi * types::unit(word & 0xffffffff));
}

/** Returns intensities of a complex field. */
types::Sonar getField(const auto& field) {
    types::Sonar ping = test::makePing(beams, bins);
    for (size_t beam = 0; beam < beams; ++beam)
        for (size_t bin = 0; bin < bins; ++bin)
            ping.bins[beam * bins + bin] = static_cast<float>(std::norm(field(beam, bin)));
    return ping;
}

TEST(SpeckleStatisticsTest, RayleighFieldsFollowTheExponentialLaw) {
    const SpeckleFigures figures = figuresOfLaw({});
    EXPECT_NEAR(figures.scintillation.value, 1, 3 * figures.scintillation.error);
    EXPECT_NEAR(figures.scintillation.error, std::sqrt(4 / figures.bins), 0.15 * figures.scintillation.error)
        << "the jackknife's error is that of a ratio of moments";
    EXPECT_NEAR(figures.contrast, 0.5227, 0.005);
    EXPECT_NEAR(figures.texture.value, 0, 3 * figures.texture.error);
    EXPECT_LT(figures.rayleigh_distance, rayleigh_distance_limit);
    EXPECT_NEAR(figures.independent, figures.bins, 0.05 * figures.bins);
    EXPECT_DOUBLE_EQ(figures.along[0], 1);
    for (size_t lag = 1; lag < speckle_lags; ++lag) {
        EXPECT_NEAR(figures.along[lag], 0, 0.02);
        EXPECT_NEAR(figures.across[lag], 0, 0.02);
    }
}

TEST(SpeckleStatisticsTest, FindTheShapeOfKWithinTheirErrorAndRejectRayleigh) {
    for (const double shape : {1.0, 3.0, 10.0}) {
        const SpeckleFigures figures = figuresOfLaw({.law = noise::SpeckleLaw::K, .shape = shape});
        EXPECT_NEAR(figures.texture.value, 1 / shape, 3 * figures.texture.error) << shape;
        EXPECT_LT(figures.texture.error, 0.1 / shape) << shape;
        EXPECT_NEAR(figures.scintillation.value, 1 + 2 / shape, 3 * figures.scintillation.error) << shape;
        EXPECT_GT(figures.rayleigh_distance, 2 * rayleigh_distance_limit) << shape;
    }
}

TEST(SpeckleStatisticsTest, SeparateAveragedLooksFromRayleigh) {
    const SpeckleFigures figures = figuresOfLaw({.law = noise::SpeckleLaw::Gamma, .looks = 4});
    EXPECT_NEAR(figures.scintillation.value, 0.25, 0.02);
    EXPECT_LT(figures.shape(), 0);
    EXPECT_GT(figures.rayleigh_distance, 10 * rayleigh_distance_limit);
}

TEST(SpeckleStatisticsTest, CorrelationIsThatOfTheIntensitiesOfNeighbours) {
    const auto shared = [](size_t beam, size_t bin) {  // neighbouring fields share a half, their intensities a quarter
        return (gaussian(1, beam, bin) + gaussian(1, beam + 1, bin)) / std::numbers::sqrt2;
    };
    const types::Sonar ping = getField(shared);
    const SpeckleFigures figures = computeFigures(overMeans(ping, test::makePing(beams, bins)));
    EXPECT_NEAR(figures.across[1], 0.25, 0.02);
    EXPECT_NEAR(figures.across[2], 0, 0.02);
    EXPECT_NEAR(figures.along[1], 0, 0.02);
    EXPECT_NEAR(figures.independent, figures.bins / 1.5, 0.05 * figures.bins);
    EXPECT_LT(figures.rayleigh_distance, rayleigh_distance_limit);
}

TEST(SpeckleStatisticsTest, TheNewPartOfEachPingIsTheNoiseShare) {
    for (const double share : {0.0, 0.1, 0.5, 1.0}) {
        const auto ping = [&](uint64_t seed) {
            return overMeans(getField([&](size_t beam, size_t bin) {
                                 return std::sqrt(1 - share) * gaussian(1, beam, bin) +
                                        std::sqrt(share) * gaussian(seed, beam, bin);
                             }),
                             test::makePing(beams, bins));
        };
        const Likewise both = likewise(ping(2), ping(3));
        EXPECT_NEAR(both.intensities, (1 - share) * (1 - share), 0.02) << share;
        EXPECT_NEAR(both.frozen(), (1 - share) * (1 - share), 0.04) << share;
        EXPECT_NEAR(both.noiseShare(), share, share < 1 ? 0.02 : 0.1) << share;
    }
}

/** Returns the ping as output by an instrument of 8 bits, its middle level at code 60. */
CodedPing coded(const types::Sonar& ping) {
    CodedPing result{.name = "coded",
                     .beam_count = ping.beam_count,
                     .bin_count = ping.bin_count,
                     .law = {.law = receiver::CodeLaw::Sqrt, .gamma = 0.5}};
    for (const float bin : ping.bins)
        result.codes.push_back(std::min(255.0f, std::round(60 * std::sqrt(std::sqrt(bin)))) / 255);
    return result;
}

TEST(SpeckleStatisticsTest, CodesOfEightBitsGiveNearlyTheSame) {
    for (const noise::SpeckleConfig& law :
         {noise::SpeckleConfig{}, noise::SpeckleConfig{.law = noise::SpeckleLaw::K, .shape = 3}}) {
        const types::Sonar ping = speckled(law);
        const SpeckleFigures from_codes = computeFigures(overPatches(coded(ping)));
        const SpeckleFigures from_bins = computeFigures(overPatches(ping));
        EXPECT_NEAR(from_codes.scintillation.value, from_bins.scintillation.value, 0.02);
        EXPECT_NEAR(from_codes.texture.value, from_bins.texture.value, 0.02);
        EXPECT_NEAR(from_codes.rayleigh_distance, from_bins.rayleigh_distance, 0.5);
        const SpeckleFigures exact = figuresOfLaw(law);
        EXPECT_NEAR(from_bins.scintillation.value, exact.scintillation.value, 0.05 * exact.scintillation.value)
            << "means of patches are estimates";
    }
}

TEST(SpeckleStatisticsTest, OmitPatchesOfTwoKindsOfBottomOrOfClippedCodes) {
    types::Sonar ping = speckled({});
    for (size_t bin = 24; bin < 32; ++bin) ping.bins[bin] *= 100;  // beams 0 to 7 of the patch at bin 16
    for (size_t beam = 1; beam < 8; ++beam)
        for (size_t bin = 24; bin < 32; ++bin) ping.bins[beam * bins + bin] *= 100;
    for (size_t i = 0; i < 16; ++i) ping.bins[32 + i] = 0;
    const SpeckleField field = overPatches(ping);
    EXPECT_FALSE(std::isnan(field.at(0, 0)));
    EXPECT_TRUE(std::isnan(field.at(0, 20)));
    EXPECT_TRUE(std::isnan(field.at(15, 40)));
    EXPECT_FALSE(std::isnan(field.at(0, 48)));
}

TEST(SpeckleStatisticsTest, RefuseFieldsThatAreTooSmallOrOfAnotherShape) {
    EXPECT_THROW(computeFigures(overPatches(test::makePing(32, 31))), std::invalid_argument);
    EXPECT_THROW(overMeans(test::makePing(2, 3), test::makePing(3, 2)), std::invalid_argument);
    EXPECT_THROW(likewise(overPatches(test::makePing(32, 32)), overPatches(test::makePing(32, 48))),
                 std::invalid_argument);
}

TEST(SpeckleStatisticsTest, DescribeEighthsOfTheRangeSeparately) {
    types::Sonar ping = speckled({}), means = test::makePing(beams, bins);
    for (size_t beam = 0; beam < beams; ++beam)
        for (size_t bin = 320; bin < 384; ++bin) ping.bins[beam * bins + bin] = means.bins[beam * bins + bin] = 9;
    EXPECT_EQ(loudestSlice(ping), 5u);
    const SpeckleField field = overMeans(ping, means);
    EXPECT_NEAR(computeFigures(getSlice(field, 5)).scintillation.value, 0, 1e-12);
    EXPECT_NEAR(computeFigures(getSlice(field, 4)).scintillation.value, 1, 0.1);
    EXPECT_EQ(computeFigures(getSlice(field, 4)).bins, beams * 64);
}

TEST(SpeckleStatisticsTest, LoudPartsOfPingsOfAnM1200dAreStillAndTheRestIsRayleighNoise) {
    const std::filesystem::path file = test::sharedFile("sonar/oculus/three_pings_8bit.raw");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there: nothing is held against recordings";
    std::vector<SpeckleField> loud, far;
    device::OculusReader reader(file);
    for (const CodedPing& ping : codedPings(reader, {})) {
        EXPECT_EQ(loudestSlice(ping), 3u);
        loud.push_back(getSlice(overPatches(ping), 3));
        far.push_back(getSlice(overPatches(ping), 7));
    }
    ASSERT_EQ(loud.size(), 3u);
    EXPECT_GT(likewise(loud[0], loud[1]).frozen(), 0.95);
    EXPECT_GT(likewise(loud[1], loud[2]).frozen(), 0.95);
    EXPECT_LT(likewise(loud[0], loud[1]).noiseShare(), 0.05);
    EXPECT_LT(likewise(far[0], far[1]).frozen(), 0.4) << "noise is new in each ping";
    for (size_t i = 0; i < 3; ++i) {
        const SpeckleFigures sediment = computeFigures(loud[i]), noise = computeFigures(far[i]);
        EXPECT_NEAR(sediment.shape(), 4, 1.5) << "K, of few scatterers";
        EXPECT_GT(sediment.texture.value, 3 * sediment.texture.error) << "not Rayleigh";
        EXPECT_NEAR(sediment.across[1], 0.6, 0.1) << "beams are closer than they are wide";
        EXPECT_LT(sediment.along[1], 0.2);
        EXPECT_LT(noise.rayleigh_distance, rayleigh_distance_limit);
        EXPECT_NEAR(noise.scintillation.value, 1, 0.1);
    }
}

}  // namespace
}  // namespace insonify::study
