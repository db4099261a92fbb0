#include <gtest/gtest.h>

#include <algorithm>

#include "types/SenderClock.hpp"

namespace insonify::types {
namespace {

using Order = SenderClock::Order;

Time at(double seconds) { return Time::fromSeconds(seconds); }

/** Offset of our clock to the sender's [s]. */
constexpr double ahead = 1000;

TEST(SenderClockTest, UsesTheMinDelayAndNotThatOfEachMessage) {
    SenderClock clock;
    EXPECT_EQ(clock.read(at(1), at(ahead + 1.020)).time, at(ahead + 1.020));
    EXPECT_EQ(clock.read(at(2), at(ahead + 2.005)).time, at(ahead + 2.005));
    const Time delayed = clock.read(at(2.9), at(ahead + 2.985)).time;
    EXPECT_NEAR(delayed.seconds(), ahead + 2.905, 0.001) << "a delay of 80 ms more has almost no effect";
    EXPECT_NEAR(clock.read(at(3), at(ahead + 3.005)).time.seconds(), ahead + 3.005, 0.001);
}

TEST(SenderClockTest, TimesNeitherDecreaseNorExceedTheArrival) {
    SenderClock clock;
    Time last;
    for (int i = 1; i < 2000; ++i) {
        const double stamp = 0.02 * i, delay = 0.001 * (i * 37 % 18);  // up to 17 ms, less than a period
        const auto [order, time] = clock.read(at(stamp), at(ahead + stamp + delay));
        EXPECT_EQ(order, Order::Next);
        EXPECT_GE(time, last);
        EXPECT_LE(time, at(ahead + stamp + delay));
        EXPECT_GE(time, at(ahead + stamp - 1e-6));
        last = time;
    }
}

TEST(SenderClockTest, FollowsASlowerClock) {
    SenderClock clock;  // as of a simulation that runs at half the speed
    for (int i = 1; i < 1000; ++i) {
        const Time arrival = at(ahead + 0.02 * i);
        const Time time = clock.read(at(0.01 * i), arrival).time;
        const Time behind = SenderClock::max_lag + SenderClock::max_doubt + at(0.02);
        EXPECT_LE(arrival - time, behind) << i;
    }
}

TEST(SenderClockTest, FollowsADriftingClockClosely) {
    SenderClock clock;
    Time time;
    for (int i = 1; i <= 50 * 600; ++i) time = clock.read(at(0.02 * i * (1 - 5e-5)), at(ahead + 0.02 * i)).time;
    EXPECT_NEAR(time.seconds(), ahead + 600, 0.001) << "after ten minutes, in which it has lost 30 ms";
}

TEST(SenderClockTest, DelayedMessagesKeepTheirSpacing) {
    SenderClock clock;
    clock.read(at(1), at(ahead + 1));
    clock.read(at(1.1), at(ahead + 1.1));
    const Time burst = at(ahead + 1.9);
    EXPECT_EQ(clock.read(at(1.2), burst).time, at(ahead + 1.2));
    EXPECT_EQ(clock.read(at(1.5), burst).time, at(ahead + 1.5));
    EXPECT_EQ(clock.read(at(1.9), burst).time, at(ahead + 1.9));
}

TEST(SenderClockTest, ReportsARepeatedStampAndContinuesAfterAPause) {
    SenderClock clock;
    clock.read(at(5), at(ahead + 5));
    for (int i = 0; i < 100; ++i)
        EXPECT_EQ(clock.read(at(5), at(ahead + 5 + i)).order, Order::Repeated) << "paused for 100 s";
    const auto [order, time] = clock.read(at(5.02), at(ahead + 105));
    EXPECT_EQ(order, Order::Next);
    EXPECT_EQ(time, at(ahead + 105)) << "the pause is no delay";
}

TEST(SenderClockTest, DropsLateStampsAndAcceptsARestartedSender) {
    SenderClock clock;
    clock.read(at(100), at(ahead + 100));
    EXPECT_EQ(clock.read(at(99.5), at(ahead + 100.1)).order, Order::Late);
    EXPECT_EQ(clock.read(at(100.1), at(ahead + 100.1)).order, Order::Next);
    const auto [order, time] = clock.read(at(0), at(ahead + 100.2));
    EXPECT_EQ(order, Order::Restarted) << "a simulation that was reset";
    EXPECT_EQ(time, at(ahead + 100.2));
    EXPECT_EQ(clock.read(at(0.1), at(ahead + 100.3)).time, at(ahead + 100.3));
}

TEST(SenderClockTest, AcceptsEarlierStampsAfterASilence) {
    SenderClock clock;
    clock.read(at(0.8), at(ahead));
    EXPECT_EQ(clock.read(at(0.1), at(ahead + 0.5)).order, Order::Late);
    EXPECT_EQ(clock.read(at(0.2), at(ahead + 2)).order, Order::Restarted);
}

TEST(SenderClockTest, LateStampsInARowAreARestartOfAYoungSender) {
    SenderClock clock;
    clock.read(at(0.8), at(ahead));
    for (int i = 1; i < SenderClock::max_late; ++i)
        EXPECT_EQ(clock.read(at(0), at(ahead + 0.02 * i)).order, Order::Late) << "reset, and paused there";
    EXPECT_EQ(clock.read(at(0), at(ahead + 0.1)).order, Order::Restarted);
    EXPECT_EQ(clock.read(at(0.02), at(ahead + 0.12)).order, Order::Next);
    for (int i = 1; i < 100; ++i) {  // two senders, of which one is 20 ms behind
        EXPECT_EQ(clock.read(at(0.02 + 0.02 * i), at(ahead + 1 + 0.02 * i)).order, Order::Next);
        EXPECT_EQ(clock.read(at(0.01 + 0.02 * i), at(ahead + 1 + 0.02 * i)).order, Order::Late);
    }
}

TEST(SenderClockTest, StampsThatArriveAtOneInstantHaveTimesOfTheirOwn) {
    SenderClock clock;
    Time last;
    for (const double stamp : {1.0, 1.05, 1.1, 1.15, 9.0, 9.1}) {
        const Time time = clock.read(at(stamp), at(ahead)).time;
        EXPECT_GT(time, last);
        EXPECT_LE(time, at(ahead + 1e-5));
        last = time;
    }
}

TEST(SenderClockTest, AStampFarAheadDoesNotBlockLaterStamps) {
    SenderClock clock;
    clock.read(at(1), at(ahead + 1));
    EXPECT_EQ(clock.read(at(1e6), at(ahead + 1.1)).time, at(ahead + 1.1));
    const auto [order, time] = clock.read(at(1.2), at(ahead + 1.2));
    EXPECT_EQ(order, Order::Restarted);
    EXPECT_EQ(time, at(ahead + 1.2));
}

TEST(SenderClockTest, TimesFollowOurClockWhenItIsSetBack) {
    SenderClock clock;
    clock.read(at(1), at(ahead + 3600));
    EXPECT_EQ(clock.read(at(1.1), at(ahead)).time, at(ahead));
}

/** A stream of 50 messages a second, while the clock of one side or of both is set by ten minutes. */
TEST(SenderClockTest, AStreamGoesOnWhenEitherClockIsSetByTenMinutes) {
    for (const double ours : {-600.0, 0.0, 600.0})
        for (const double senders : {-600.0, 0.0, 600.0})
            for (const double apart : {0.0, 0.3, 4.0}) {  // between the two steps [s]
                SenderClock clock;
                int dropped = 0;
                Time worst;
                for (int i = 0; i < 1000; ++i) {
                    const double now = 0.02 * i, delay = 0.001 * (i * 37 % 18);
                    const Time stamp = at(2000 + now + (now >= 5 ? senders : 0));
                    const double set = now + delay >= 5 + apart ? ours : 0;
                    const Time arrival = at(ahead + 2000 + now + delay + set);
                    const auto [order, time] = clock.read(stamp, arrival);
                    dropped += order == Order::Late || order == Order::Repeated;
                    EXPECT_LE(time, arrival);
                    if (order == Order::Next || order == Order::Restarted) worst = std::max(worst, arrival - time);
                }
                const Time longest = SenderClock::max_lag + SenderClock::max_doubt + at(0.04);
                EXPECT_LE(worst, longest) << ours << ", " << senders << ", " << apart;
                EXPECT_LE(dropped, 1) << ours << ", " << senders << ", " << apart;
            }
}

}  // namespace
}  // namespace insonify::types
