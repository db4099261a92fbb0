// Which ping answers which request, and how long a request waits.
#include <gtest/gtest.h>

#include "components/device/AskedPings.hpp"

namespace insonify::device {
namespace {

types::Time at(double seconds) { return types::Time::fromSeconds(1e9 + seconds); }

TEST(AskedPingsTest, APingAnswersTheNewestEarlierRequestAndEndsOlderRequests) {
    AskedPings<char> asked(3);
    for (const char kept : {'a', 'b', 'c'}) asked.add(at(kept - 'a'), at(0), kept);
    EXPECT_FALSE(asked.take(at(-1e-6))) << "no request for it";
    EXPECT_EQ(asked.take(at(1.5)), 'b');
    EXPECT_EQ(asked.size(), 1u);
    EXPECT_FALSE(asked.take(at(1.5))) << "once";
    EXPECT_EQ(asked.take(at(2)), 'c');
    EXPECT_TRUE(asked.empty());
    EXPECT_FALSE(asked.awaits(at(9)));
}

TEST(AskedPingsTest, GivesUpTheOldestOfTooManyRequests) {
    AskedPings<char> asked(2);
    for (const char kept : {'a', 'b', 'c'}) asked.add(at(kept - 'a'), at(0), kept);
    EXPECT_FALSE(asked.take(at(0.5)));
    EXPECT_EQ(asked.take(at(1.5)), 'b');
}

TEST(AskedPingsTest, TheNewestIsLateAfterItsSoundAndThePatience) {
    AskedPings<> asked;
    EXPECT_FALSE(asked.isLate(at(100)));
    asked.add(at(0), at(0.5));
    EXPECT_EQ(asked.deadline(), at(2.5));
    EXPECT_EQ(asked.deadline(4), at(4.5));
    EXPECT_FALSE(asked.isLate(at(2.499999)));
    EXPECT_TRUE(asked.isLate(at(2.5)));
    asked.add(at(3), at(3.5));
    EXPECT_EQ(asked.size(), 1u);
    EXPECT_FALSE(asked.isLate(at(3)));
    asked.clear();
    EXPECT_FALSE(asked.isLate(at(100)));
}

}  // namespace
}  // namespace insonify::device
