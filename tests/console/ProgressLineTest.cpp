#include <gtest/gtest.h>

#include <cmath>

#include "components/console/ProgressLine.hpp"

namespace insonify::console {
namespace {

TEST(ProgressLineTest, ComputesTheTimeLeftFromTheFinishedShare) {
    EXPECT_EQ(timeLeft(0.25, 10), ", 25 % done, 30 s left");
    EXPECT_EQ(timeLeft(0.5, 300), ", 50 % done, 5 min 00 s left");
    EXPECT_EQ(timeLeft(0.001, 10), ", 0 % done, 2 h 46 min left");
    for (const double share : {0.0, -1.0, 1.0, 1.5, std::nan("")}) EXPECT_EQ(timeLeft(share, 10), "") << share;
}

}  // namespace
}  // namespace insonify::console
