// Threads that are refused, their scheduling, and mutexes with priority inheritance.
#include <gmock/gmock.h>

#include <condition_variable>

#include "tests/support/Priorities.hpp"
#include "tests/support/ThreadLimit.hpp"
#include "types/Thread.hpp"

namespace insonify::types {
namespace {

using test::policyOfThis;
using test::urgentIsFirst;
using test::useFifo;

TEST(ThreadTest, ARefusedThreadIsAnErrorWithItsPurposeAndTheLimits) {
    const test::ThreadLimit limit(0);
    try {
        startThread("the log", [] {}).join();
        FAIL() << "it has started";
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(),
                    testing::AllOf(testing::HasSubstr("no thread for the log: "), testing::HasSubstr("ulimit -u")));
    }
}

TEST(ThreadTest, AThreadOfARealtimeTaskCanLeaveItsPriority) {
    std::atomic<int> inherited{-1}, left{-1};
    bool permitted = false;
    std::thread([&] {
        permitted = useFifo(3);
        startThread("a test", [&] {
            inherited = policyOfThis();
            useDefaultScheduling();
            left = policyOfThis();
        }).join();
    }).join();
    if (!permitted) GTEST_SKIP() << "SKIPPED: SCHED_FIFO is not permitted";
    EXPECT_EQ(inherited, SCHED_FIFO);
    EXPECT_EQ(left, SCHED_OTHER);
}

template <class Mutex>
struct Locked {
    Mutex mutex;
    void work(const auto& job) {
        const std::lock_guard lock(mutex);
        job();
    }
    void wait(std::thread& /*worker*/) { const std::lock_guard lock(mutex); }
};

template <bool Lends>
struct Awaited {
    std::mutex mutex;
    std::condition_variable changed;
    bool is_done = false;
    void work(const auto& job) {
        job();
        const std::lock_guard lock(mutex);
        is_done = true;
        changed.notify_all();
    }
    void wait(std::thread& worker) {
        std::optional<LentScheduling> lent;
        if (Lends) lent.emplace(worker);
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return is_done; });
    }
};

/** Returns whether an urgent thread is late in one of several tries: on a busy machine not in each. */
template <class Shared>
bool isLateOnce() {
    for (int i = 0; i < 64; ++i) {  // a loaded machine may move the urgent thread in time
        Shared shared;
        if (!*urgentIsFirst(shared)) return true;
    }
    return false;
}

TEST(ThreadTest, AnUrgentThreadWaitsForTheOwnerOfAPriorityMutexOnly) {
    Locked<PriorityMutex> inherits;
    const auto first = urgentIsFirst(inherits);
    if (!first) GTEST_SKIP() << "SKIPPED: SCHED_FIFO is not permitted";
    EXPECT_TRUE(*first);
    EXPECT_TRUE(isLateOnce<Locked<std::mutex>>()) << "the test cannot tell";
}

TEST(ThreadTest, AThreadThatIsWaitedForHasTheSchedulingThatItIsLent) {
    Awaited<true> lends;
    const auto first = urgentIsFirst(lends);
    if (!first) GTEST_SKIP() << "SKIPPED: SCHED_FIFO is not permitted";
    EXPECT_TRUE(*first);
    EXPECT_TRUE(isLateOnce<Awaited<false>>()) << "the test cannot tell";
}

TEST(ThreadTest, AConditionVariableWaitsWithAPriorityMutex) {
    PriorityMutex mutex;
    std::condition_variable changed;
    int turn = 0;
    std::thread other([&] {
        for (int i = 0; i < 1000; ++i) {
            std::unique_lock<std::mutex> lock(mutex);
            changed.wait(lock, [&] { return turn == 1; });
            turn = 0;
            changed.notify_all();
        }
    });
    for (int i = 0; i < 1000; ++i) {
        std::unique_lock<std::mutex> lock(mutex);
        turn = 1;
        changed.notify_all();
        changed.wait(lock, [&] { return turn == 0; });
    }
    other.join();
}

}  // namespace
}  // namespace insonify::types
