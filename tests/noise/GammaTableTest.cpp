#include <gtest/gtest.h>

#include <cmath>

#include "components/noise/Noise.hpp"

namespace insonify::noise {
namespace {

float variate(const GammaTable& table, double t) { return GammaTable::variate(table.values(), static_cast<float>(t)); }

TEST(GammaTableTest, ShapeOneIsTheExponential) {
    const GammaTable table(1);
    for (double t = 1.2e-10; t < 22.9; t *= 1.0173) EXPECT_NEAR(variate(table, t) / t, 1, 2e-5) << t;
}

TEST(GammaTableTest, ShapeOneHalfIsTheSquareOfANormal) {
    const GammaTable table(0.5);  // x = z^2 has the upper tail erfc(z / sqrt(2))
    for (const double z : {1e-4, 0.01, 0.3, 1.0, 2.0, 4.0, 6.0})
        EXPECT_NEAR(variate(table, -std::log(std::erfc(z / std::sqrt(2.0)))) / (z * z), 1, 2e-3) << z;
}

TEST(GammaTableTest, ALargeShapeIsTheNormalLaw) {
    const GammaTable table(1e6);
    for (const double z : {-5.0, -2.0, -0.5, 0.5, 2.0, 5.0})
        EXPECT_NEAR((variate(table, -std::log(0.5 * std::erfc(z / std::sqrt(2.0)))) - 1) * 1e3, z, 0.01) << z;
}

TEST(GammaTableTest, TheMinShapeIsFiniteWithALongTail) {
    const GammaTable table(1e-3);
    EXPECT_EQ(variate(table, 1), 0) << "nearly all is nothing";
    EXPECT_GT(variate(table, 22.9), 1e4);
    float last = 0;
    for (double t = 1.2e-10; t < 22.9; t *= 1.01) {
        EXPECT_GE(variate(table, t), last) << t;
        last = variate(table, t);
    }
    EXPECT_TRUE(std::isfinite(last));
}

}  // namespace
}  // namespace insonify::noise
