// Which ping answers which request, and how long a request waits.
#include <gtest/gtest.h>

#include "components/device/RequestedPings.hpp"

namespace insonify::device {
namespace {

types::Time at(double seconds) { return types::Time::fromSeconds(1e9 + seconds); }

TEST(RequestedPingsTest, APingAnswersTheNewestEarlierRequestAndEndsOlderRequests) {
    RequestedPings<char> request(3);
    for (const char kept : {'a', 'b', 'c'}) request.add(at(kept - 'a'), at(0), kept);
    EXPECT_FALSE(request.take(at(-1e-6))) << "no request for it";
    EXPECT_EQ(request.take(at(1.5)), 'b');
    EXPECT_EQ(request.size(), 1u);
    EXPECT_FALSE(request.take(at(1.5))) << "once";
    EXPECT_EQ(request.take(at(2)), 'c');
    EXPECT_TRUE(request.empty());
    EXPECT_FALSE(request.awaits(at(9)));
}

TEST(RequestedPingsTest, GivesUpTheOldestOfTooManyRequests) {
    RequestedPings<char> request(2);
    for (const char kept : {'a', 'b', 'c'}) request.add(at(kept - 'a'), at(0), kept);
    EXPECT_FALSE(request.take(at(0.5)));
    EXPECT_EQ(request.take(at(1.5)), 'b');
}

TEST(RequestedPingsTest, TheNewestIsLateAfterItsSoundAndThePatience) {
    RequestedPings<> request;
    EXPECT_FALSE(request.isLate(at(100)));
    request.add(at(0), at(0.5));
    EXPECT_EQ(request.deadline(), at(2.5));
    EXPECT_EQ(request.deadline(4), at(4.5));
    EXPECT_FALSE(request.isLate(at(2.499999)));
    EXPECT_TRUE(request.isLate(at(2.5)));
    request.add(at(3), at(3.5));
    EXPECT_EQ(request.size(), 1u);
    EXPECT_FALSE(request.isLate(at(3)));
    request.clear();
    EXPECT_FALSE(request.isLate(at(100)));
}

}  // namespace
}  // namespace insonify::device
