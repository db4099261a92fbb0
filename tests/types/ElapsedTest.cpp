#include <gtest/gtest.h>

#include "types/Time.hpp"

namespace insonify::types {
namespace {

TEST(ElapsedTest, WhatIsDueWaitsForItsPeriodAndNotForAClockThatWasSetBack) {
    constexpr Time last{100}, period{10};
    EXPECT_FALSE(due(last, period, Time{100}));
    EXPECT_FALSE(due(last, period, Time{109}));
    EXPECT_TRUE(due(last, period, Time{110}));
    EXPECT_TRUE(due(last, period, Time{99})) << "the clock was set back";
    EXPECT_TRUE(due(last, period, Time{-1'800'000'000'000'000})) << "by decades";
    EXPECT_TRUE(due(last, period, Time{1'800'000'000'000'000}));
    // Set back into the period: less than a period more.
    EXPECT_FALSE(due(last, period, Time{102}));
}

TEST(ElapsedTest, SteadyTimeIsTheClocksUntilItIsSetBack) {
    SteadyTime steady;
    for (const int64_t time : {int64_t{5}, int64_t{5}, int64_t{1000}, int64_t{1'800'000'000'000'000}})
        EXPECT_EQ(steady.read({time}), Time{time});
    EXPECT_FALSE(steady.jumpedBack());
}

TEST(ElapsedTest, SteadyTimeNeverGoesBackAndKeepsIntervals) {
    SteadyTime steady;
    steady.read({100});
    EXPECT_EQ(steady.read({40}), Time{100});
    EXPECT_EQ(steady.read({47}), Time{107});
    EXPECT_FALSE(steady.jumpedBack()) << "by a few microseconds";
    EXPECT_EQ(steady.steady({50}), Time{110});
    EXPECT_EQ(steady.clock({110}), Time{50});
    EXPECT_EQ(steady.read({-1000}), Time{107});
    EXPECT_EQ(steady.clock({108}), Time{-999});
    EXPECT_EQ(steady.read({-2'000'000}), Time{107});
    EXPECT_TRUE(steady.jumpedBack());
    steady.read({-1'999'999});
    EXPECT_FALSE(steady.jumpedBack());
}

}  // namespace
}  // namespace insonify::types
