// Noise after a receiver's filter and averaging of looks, compared with closed forms.
#include <gmock/gmock.h>

#include <optional>

#include "components/noise/Noise.hpp"
#include "tests/noise/Distributions.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::noise {
namespace {

constexpr uint32_t beams = 256, bins = 1000;

NoiseConfig filtered(const FilterConfig& filter, std::optional<SpeckleConfig> speckle = SpeckleConfig{}) {
    NoiseConfig config;
    config.speckle = speckle;
    config.filter = filter;
    return config;
}

types::Sonar filteredField(const FilterConfig& filter) { return makeNoisy(filtered(filter), makePing(beams, bins)); }

/** Returns the correlation of intensities at a distance in beams and bins. */
double correlationAt(const types::Sonar& ping, size_t across, size_t along) {
    double sum = 0;
    const size_t count = ping.bin_count - along;
    for (size_t beam = 0; beam + across < ping.beam_count; ++beam)
        for (size_t bin = 0; bin < count; ++bin)
            sum += (static_cast<double>(ping.bins[beam * ping.bin_count + bin]) - 1) *
                   (static_cast<double>(ping.bins[(beam + across) * ping.bin_count + bin + along]) - 1);
    return sum / static_cast<double>(count * (ping.beam_count - across)) / computeVariance(ping.bins);
}

/** Returns the skew of the logarithm of gamma variates of `looks`: psi''(L) / psi'(L)^1.5. */
double computeLogSkew(int looks) {
    double trigamma = 0, tetragamma = 0;
    for (int k = looks; k < 100000; ++k) trigamma += 1 / std::pow(k, 2), tetragamma -= 2 / std::pow(k, 3);
    return tetragamma / std::pow(trigamma, 1.5);
}

double logSkew(const std::vector<float>& values) {
    double mean = 0, second = 0, third = 0;
    const auto count = static_cast<double>(values.size());
    for (const float value : values) mean += std::log(static_cast<double>(value)) / count;
    for (const float value : values) {
        const double off = std::log(static_cast<double>(value)) - mean;
        second += off * off / count, third += off * off * off / count;
    }
    return third / std::pow(second, 1.5);
}

TEST(FieldFilterTest, TapsHaveTheCorrelationOfTheClosedFormAtEveryLag) {
    for (const double width : {0.1, 0.4, 0.7, 1.0, 1.346, 3.0, 7.5, 16.0}) {
        const std::vector<float> half = gaussianFilter(width);
        const int reach = static_cast<int>(half.size()) - 1;
        EXPECT_LE(reach, 64);
        const auto tap = [&](int t) {
            return std::abs(t) > reach ? 0.0 : static_cast<double>(half[static_cast<size_t>(std::abs(t))]);
        };
        for (int lag = 0; lag < 40; ++lag) {
            double sum = 0;
            for (int t = -reach; t <= reach + lag; ++t) sum += tap(t) * tap(t - lag);
            EXPECT_NEAR(sum, std::exp(-0.5 * std::pow(lag / width, 2)), 2e-4) << width << " at " << lag;
        }
    }
}

TEST(FieldFilterTest, IntensitiesCorrelateByTheClosedFormInRangeAndAcrossBeams) {
    struct Case {
        int looks;
        double along, across;
    };
    for (const auto& [looks, along, across] : {Case{1, 1.346, 0.3}, Case{4, 2.5, 1.5}, Case{2, 0.5, 3}}) {
        const types::Sonar ping = filteredField({looks, along, across});
        EXPECT_NEAR(computeMean(ping.bins), 1, 0.02);
        EXPECT_NEAR(computeVariance(ping.bins), 1.0 / looks, 0.05 / looks);
        for (const size_t lag : {1u, 2u, 3u}) {
            const double x = static_cast<double>(lag);
            EXPECT_NEAR(correlationAt(ping, 0, lag), std::exp(-std::pow(x / along, 2)), 0.02) << along << ' ' << lag;
            EXPECT_NEAR(correlationAt(ping, lag, 0), std::exp(-std::pow(x / across, 2)), 0.02) << across << ' ' << lag;
        }
        EXPECT_NEAR(correlationAt(ping, 1, 1), std::exp(-1 / (along * along) - 1 / (across * across)), 0.02);
    }
}

TEST(FieldFilterTest, LooksAreGammaDistributedWithTheSkewOfTheLogarithm) {
    for (const int looks : {1, 2, 4, 16, 64}) {
        const types::Sonar ping = filteredField({looks, {}, {}});
        const auto all = shares(ping.bins, [&](double x) { return gammaCdf(x, looks); });
        EXPECT_LT(kolmogorovSmirnov(all), ks_one_percent) << looks;
        EXPECT_NEAR(logSkew(ping.bins), computeLogSkew(looks), 0.03) << looks;
        const types::Sonar correlated = filteredField({looks, 1.3, {}});
        EXPECT_NEAR(logSkew(correlated.bins), computeLogSkew(looks), 0.06) << looks << ": a filter keeps the law";
    }
    EXPECT_NEAR(computeLogSkew(1), -1.1395, 1e-3) << "of the exponential law (Gumbel's)";
}

TEST(FieldFilterTest, FiltersKSpeckleTheSeaAndAdditiveNoiseToo) {
    const FilterConfig filter{4, 1.346, {}};
    const auto computeLag = [](const types::Sonar& ping) {
        return correlation(ping.bins.data(), ping.bins.data() + 1, ping.bins.size() - 1);
    };
    NoiseConfig sea = withSea(filtered(filter, {}), 0), added = background(0);
    added.filter = filter;
    const types::Sonar empty = makePing(beams, bins, 0);
    for (const NoiseConfig& config : {sea, added}) {
        const types::Sonar ping = makeNoisy(config, empty);
        EXPECT_NEAR(computeMean(ping.bins), 1, 0.02);
        EXPECT_NEAR(computeVariance(ping.bins), 0.25, 0.02);
        EXPECT_NEAR(computeLag(ping), std::exp(-std::pow(1 / 1.346, 2)), 0.02);
    }
    EXPECT_NE(makeNoisy(sea, empty).bins, makeNoisy(added, empty).bins) << "streams of their own";
    const types::Sonar k =
        makeNoisy(filtered(filter, SpeckleConfig{.law = SpeckleLaw::K, .shape = 2}), makePing(beams, bins));
    EXPECT_NEAR(computeVariance(k.bins), 1.5 * 1.25 - 1, 0.05) << "(1 + 1/nu) (1 + 1/L) - 1";
    const types::Sonar rayleigh_in_sea = makeNoisy(withSea(filtered(filter), 0), makePing(beams, bins));
    EXPECT_NEAR(computeMean(rayleigh_in_sea.bins), 2, 0.04);
    EXPECT_NEAR(computeVariance(rayleigh_in_sea.bins), 1, 0.08) << "fields that add: (I0 + a)^2 / L";
}

TEST(FieldFilterTest, NoiseOfABinDependsOnlyOnSeedPingBeamAndBin) {
    const NoiseConfig config = filtered({3, 2, 2});
    const types::Sonar small = makeNoisy(config, makePing(3, 70)), large = makeNoisy(config, makePing(9, 1000));
    for (size_t beam = 0; beam < 3; ++beam)
        for (size_t bin = 0; bin < 70; ++bin) EXPECT_EQ(small.bins[beam * 70 + bin], large.bins[beam * 1000 + bin]);
    Noise noise(config);
    types::Sonar first, between, again;
    noise.add(makePing(4, 300), first);
    noise.add(makePing(7, 100, 1, 99), between);
    noise.add(makePing(4, 300), again);
    EXPECT_EQ(first.bins, again.bins);
    NoiseConfig other = config;
    other.seed = 2;
    EXPECT_LT(std::abs(correlation(first.bins.data(), makeNoisy(other, makePing(4, 300)).bins.data(), 1200)), 0.2);
    EXPECT_LT(std::abs(correlation(first.bins.data(), makeNoisy(config, makePing(4, 300, 1, 99)).bins.data(), 1200)),
              0.2);
}

TEST(FieldFilterTest, NaNStaysAndNoBinBecomesNegative) {
    types::Sonar clean = makePing(5, 300);
    clean.bins[7] = std::numeric_limits<float>::quiet_NaN();
    const types::Sonar ping = makeNoisy(filtered({1, 16, 16}), clean);
    for (size_t i = 0; i < ping.bins.size(); ++i)
        EXPECT_TRUE(i == 7 ? std::isnan(ping.bins[i]) : ping.bins[i] >= 0) << i;
}

TEST(FieldFilterTest, AFilterWithoutNoiseChangesNothing) {
    const types::Sonar clean = makePing(5, 300);
    EXPECT_EQ(makeNoisy(filtered({4, 1.5, 2.0}, {}), clean).bins, clean.bins);
}

TEST(FieldFilterTest, RejectsAFilterWithoutAField) {
    using testing::ElementsAre, testing::IsEmpty, test::countRefusals;
    EXPECT_THAT(countRefusals(filtered({4, 1, {}})), IsEmpty());
    EXPECT_THAT(countRefusals(NoiseConfig{}), IsEmpty());
    EXPECT_THAT(countRefusals(filtered({4, 1, {}}, {})), IsEmpty());
    EXPECT_THAT(
        countRefusals(filtered({4, 1, {}}, SpeckleConfig{.law = SpeckleLaw::Gamma, .looks = 4})),
        ElementsAre("filter: is given with speckle.law: gamma; give law: rayleigh, whose looks filter.looks averages"));
    EXPECT_THAT(countRefusals(filtered({4, 1, {}}, SpeckleConfig{.law = SpeckleLaw::Gaussian})),
                ElementsAre("filter: is given with speckle.law: gaussian, which is no field; give rayleigh or k"));
}

/** The first and the last beam of a ring, and beams that a table lists far apart, are neighbours. */
TEST(FieldFilterTest, NeighboursAlongTheArcCorrelateInAnyOrderOfBeamsAndRoundARing) {
    for (const uint32_t count : {24u, 7u}) {
        for (const uint32_t step : {1u, 5u}) {
            types::Sonar clean = makePing(count, 20000);
            for (uint32_t k = 0; k < count; ++k)  // beam k of the ring is in row k * step % count
                clean.bearings[k * step % count] = types::Angle::fromDeg(360.0 * (k + 0.5) / count - 180);
            clean.beam_width = types::Angle::fromDeg(360.0 / count);
            const types::Sonar noisy = makeNoisy(filtered({1, {}, 1.5}), clean);
            const auto beam = [&](uint32_t k) { return &noisy.bins[size_t{k % count * step % count} * 20000]; };
            for (uint32_t k = 0; k < count; ++k) {
                EXPECT_NEAR(correlation(beam(k), beam(k + 1), 20000), std::exp(-1 / 2.25), count > 20 ? 0.05 : 0.2)
                    << k;
                double mean = 0;
                for (size_t bin = 0; bin < 20000; ++bin) mean += double{beam(k)[bin]} / 20000;
                EXPECT_NEAR(mean, 1, 0.05) << k;
            }
        }
    }
}

}  // namespace
}  // namespace insonify::noise
