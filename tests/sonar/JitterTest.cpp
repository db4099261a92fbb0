#include <gtest/gtest.h>
#include <sys/types.h>

#include <cmath>
#include <utility>
#include <vector>

namespace insonify::sonar {
namespace {

#include "shaders/jitter.glsl"

constexpr uint rows = 256, columns = 512;

/** Returns the mean of the products of `which` of each pixel and `other` of a pixel some rows and columns further. */
double product(uint which, uint other, uint row_step, uint column_step) {
    double sum = 0;
    for (uint row = 0; row < rows; ++row)
        for (uint column = 0; column < columns; ++column)
            sum += jitter(column, row, which) * jitter(column + column_step, row + row_step, other);
    return sum / (rows * columns);
}

TEST(JitterTest, PointsAreUniformInTheirPixelsAndDoNotFollowOneAnother) {
    constexpr double count = rows * columns, variance = 1.0 / 12;
    for (uint which : {0u, 1u}) {
        std::vector<double> tenths(10);
        double sum = 0;
        for (uint row = 0; row < rows; ++row)
            for (uint column = 0; column < columns; ++column) {
                const double x = jitter(column, row, which);
                ASSERT_TRUE(x >= -0.5 && x < 0.5);
                sum += x;
                tenths[static_cast<size_t>((x + 0.5) * 10)] += 10 / count;
            }
        EXPECT_LT(std::abs(sum / count), 4 * std::sqrt(variance / count));
        for (const double share : tenths) EXPECT_NEAR(share, 1, 4 * std::sqrt(9 / count));
        EXPECT_NEAR(product(which, which, 0, 0), variance, 1e-3);
        for (const auto& [row, column] : {std::pair{0u, 1u}, {1u, 0u}, {1u, 1u}})
            EXPECT_LT(std::abs(product(which, which, row, column)), 4 * variance / std::sqrt(count));
    }
    EXPECT_LT(std::abs(product(0, 1, 0, 0)), 4 * variance / std::sqrt(count)) << "column and row of one pixel";
}

TEST(JitterTest, TheHashMatchesItsPublication) {
    EXPECT_DOUBLE_EQ(jitter(0, 0, 0), 129708002 / 4294967296.0 - 0.5);
    EXPECT_DOUBLE_EQ(jitter(0, 0, 1), 2831084092 / 4294967296.0 - 0.5);
}

}  // namespace
}  // namespace insonify::sonar
