#include <gtest/gtest.h>

#include "components/viewer/Refusals.hpp"

namespace insonify::viewer {
namespace {

TEST(RefusalsTest, TheFirstIsToldAtOnceAndTheOthersEveryTenSeconds) {
    const auto start = Refusals::Clock::now();
    Refusals refusals;
    EXPECT_EQ(refusals.untold(start), "");
    refusals.add("no HTTP");
    EXPECT_EQ(refusals.untold(start), "1 connection refused; the last: no HTTP");
    refusals.add("no HTTP");
    refusals.add("a wrong token");
    EXPECT_EQ(refusals.untold(start + std::chrono::seconds(9)), "");
    EXPECT_EQ(refusals.untold(start + std::chrono::seconds(10)), "3 connections refused; the last: a wrong token");
    EXPECT_EQ(refusals.untold(start + std::chrono::seconds(30)), "");
}

}  // namespace
}  // namespace insonify::viewer
