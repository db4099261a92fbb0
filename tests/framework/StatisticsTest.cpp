#include <gtest/gtest.h>

#include "components/framework/execution/Timing.hpp"

namespace insonify::framework {
namespace {

TEST(StatisticsTest, QuantilesAreWithinOnePercent) {
    Statistics statistics;
    for (int i = 1; i <= 1000; ++i) statistics.add(i * 1e-3);
    EXPECT_NEAR(statistics.median(), 0.5, 0.0051);
    EXPECT_NEAR(statistics.p99(), 0.99, 0.01);
    EXPECT_EQ(statistics.max(), 1);
    EXPECT_EQ(statistics.count(), 1000u);
}

TEST(StatisticsTest, EmptyAndExtremeValuesAreFinite) {
    Statistics statistics;
    EXPECT_EQ(statistics.median(), 0);
    for (const double seconds : {0.0, 1e-12, 1e9}) statistics.add(seconds);
    EXPECT_LE(statistics.quantile(0), 1e-7);
    EXPECT_LE(statistics.median(), 1e-7);
    EXPECT_NEAR(statistics.quantile(1), 1000, 20);
}

}  // namespace
}  // namespace insonify::framework
