#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "components/sonar/renderer/Metrics.hpp"

namespace insonify::sonar {
namespace {

/** Two beams of ten bins with echoes at bins 2 to 5 and at 9. */
const std::vector<double> reference = {0, 0, 8, 4, 2, 1, 0, 0, 0, 1, 0, 0, 8, 4, 2, 1, 0, 0, 0, 1};
const Layout layout{2, 10, 0.5, 0};

std::vector<float> like(const std::vector<double>& values) { return {values.begin(), values.end()}; }

TEST(MetricsTest, AnEqualPingIsFreeOfError) {
    const Metrics m = compare(like(reference), reference, layout);
    EXPECT_EQ(m.rel_l2, 0);
    EXPECT_EQ(m.rel_l2_tvg, 0);
    EXPECT_EQ(m.db_rmse, 0);
    EXPECT_EQ(m.missing_bins + m.ghost_bins, 0);
    EXPECT_EQ(m.first_return_bins + m.shadow_bins, 0);
    EXPECT_EQ(m.energy_bias, 0);
    EXPECT_EQ(m.ripple, 0);
}

TEST(MetricsTest, TenPercentMoreIsTenPercentInEveryMeasure) {
    std::vector<float> louder = like(reference);
    for (float& e : louder) e *= 1.1f;
    const Metrics m = compare(louder, reference, layout);
    EXPECT_NEAR(m.rel_l2, 0.1, 1e-6);
    EXPECT_NEAR(m.rel_l2_tvg, 0.1, 1e-6);
    EXPECT_NEAR(m.mean_rel_l2, 0.1, 1e-6);
    EXPECT_NEAR(m.db_rmse, 0.414, 1e-3);
    EXPECT_NEAR(m.db_p95, 0.414, 1e-3);
    EXPECT_NEAR(m.energy_bias, 0.1, 1e-6);
    EXPECT_NEAR(m.ripple, 0.1, 1e-6);
}

TEST(MetricsTest, CorrelationIgnoresGainAndDetectsShifts) {
    std::vector<float> louder = like(reference), flat(reference.size(), 3), swapped = like(reference);
    for (float& e : louder) e *= 2;
    std::swap(swapped[2], swapped[6]);
    EXPECT_EQ(compare(like(reference), reference, layout).correlation, 1);
    EXPECT_NEAR(compare(louder, reference, layout).correlation, 1, 1e-12);
    EXPECT_EQ(compare(flat, reference, layout).correlation, 0);
    EXPECT_LT(compare(swapped, reference, layout).correlation, 0.7);
}

TEST(MetricsTest, DistanceOfLevelsDetectsGainAndIgnoresShifts) {
    std::vector<float> louder = like(reference), swapped = like(reference);
    for (float& e : louder) e *= 2;
    std::swap(swapped[2], swapped[6]);
    EXPECT_EQ(compare(swapped, reference, layout).level_distance, 0);
    EXPECT_NEAR(compare(louder, reference, layout).level_distance, 10 * std::log10(2) / 2, 1e-6)
        << "half of the bins are silent in both";
}

TEST(MetricsTest, ComparesSilenceToo) {
    const std::vector<double> silence(reference.size(), 0);
    const Metrics same = compare(like(silence), silence, layout), other = compare(like(reference), silence, layout);
    EXPECT_EQ(same.rel_l2, 0);
    EXPECT_EQ(same.correlation, 1);
    EXPECT_EQ(same.level_distance, 0);
    EXPECT_EQ(other.rel_l2, std::numeric_limits<double>::infinity());
    EXPECT_EQ(other.correlation, 0);
}

TEST(MetricsTest, GainMakesFarBinsCount) {
    std::vector<float> near = like(reference), far = near;
    near[2] *= 1.5f;
    far[9] *= 1.5f;
    const Metrics a = compare(near, reference, layout), b = compare(far, reference, layout);
    EXPECT_GT(a.rel_l2, 5 * b.rel_l2);
    EXPECT_GT(b.rel_l2_tvg, 5 * a.rel_l2_tvg);
}

TEST(MetricsTest, EmptyAndUnwantedBinsAreCounted) {
    std::vector<float> got = like(reference);
    got[4] = 0;
    got[7] = 1;
    got[16] = 1;
    const Metrics m = compare(got, reference, layout);
    EXPECT_EQ(m.missing_bins, 1);
    EXPECT_EQ(m.ghost_bins, 2);
}

TEST(MetricsTest, ShiftedReturnsAreCountedInBins) {
    const std::vector<float> later = {0, 0, 0, 0, 8, 4, 2, 1, 0, 1, 0, 0, 0, 0, 8, 4, 2, 1, 0, 1};
    EXPECT_EQ(compare(later, reference, layout).first_return_bins, 2);
}

TEST(MetricsTest, AFilledShadowIsCountedPerBeam) {
    std::vector<float> got = like(reference);
    got[6] = got[7] = got[8] = 1;  // of the first beam only
    EXPECT_EQ(compare(got, reference, layout).shadow_bins, 1.5);
}

TEST(MetricsTest, IgnoresBinsNearerThanTheRange) {
    std::vector<float> got = like(reference);
    got[2] = 100;
    Layout from = layout;
    from.range_from = 1.5;
    EXPECT_EQ(compare(got, reference, from).rel_l2, 0);
    EXPECT_NE(compare(got, reference, from).hash, compare(like(reference), reference, from).hash)
        << "the hash is of all bins";
}

}  // namespace
}  // namespace insonify::sonar
