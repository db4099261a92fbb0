#include <gtest/gtest.h>

#include <atomic>
#include <list>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>

#include "components/sonar/base/ThreadPool.hpp"
#include "tests/support/ThreadLimit.hpp"

namespace insonify::sonar {
namespace {

using Threads = ThreadPool::Threads;

/** Adds the threads that do the parts of a job. */
void addThreads(ThreadPool& pool, std::set<std::thread::id>& threads) {
    std::mutex alone;
    pool.run([&](int, int) {
        const std::lock_guard lock(alone);
        threads.insert(std::this_thread::get_id());
    });
}

/** Whether each part of a job is done once, and what a part throws arrives. */
void expectWorks(ThreadPool& pool) {
    std::vector<int> done(static_cast<size_t>(pool.size()));
    pool.run([&](int part, int) { ++done[static_cast<size_t>(part)]; });
    EXPECT_EQ(done, std::vector<int>(done.size(), 1));
    std::atomic<int> next = 0, sum = 0;
    pool.share([&](int, int) {
        for (int i = next++; i < 20; i = next++) sum += i;
    });
    EXPECT_EQ(sum, 190);
    EXPECT_THROW(pool.run([&](int part, int parts) {
        if (part == parts - 1) throw std::runtime_error("part");
    }),
                 std::runtime_error);
}

TEST(ThreadPoolTest, EachPartIsDoneOnceAndBeforeRunReturns) {
    for (const int threads : {1, 2, 5}) {
        ThreadPool pool(threads);
        EXPECT_EQ(pool.size(), threads);
        for (int job = 0; job < 500; ++job) {
            std::vector<int> done(static_cast<size_t>(threads));  // not atomic: run() orders the accesses
            pool.run([&](int part, int parts) {
                EXPECT_EQ(parts, threads);
                done[static_cast<size_t>(part)] += job + 1;
            });
            EXPECT_EQ(std::accumulate(done.begin(), done.end(), 0), threads * (job + 1));
        }
    }
}

TEST(ThreadPoolTest, TheTimeOfJobsIsCountedByTheirCaller) {
    for (const int threads : {1, 3}) {
        ThreadPool pool(threads);
        const double before = divided_seconds;
        const auto sleep = [](int, int) { std::this_thread::sleep_for(std::chrono::milliseconds(20)); };
        pool.run(sleep);
        pool.share(sleep);
        const double in_jobs = divided_seconds - before;
        EXPECT_GE(in_jobs, (threads == 1 ? 0.04 : 0.02) * 0.99) << threads;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        EXPECT_EQ(divided_seconds - before, in_jobs) << "outside of jobs";
    }
}

TEST(ThreadPoolTest, TheTimeOfAJobWithinAJobIsCountedOnce) {
    ThreadPool pool(1), inner(1);
    const double before = divided_seconds;
    const auto start = std::chrono::steady_clock::now();
    pool.run([&](int, int) {
        for (int i = 0; i < 3; ++i)
            inner.share([](int, int) { std::this_thread::sleep_for(std::chrono::milliseconds(10)); });
    });
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    EXPECT_GE(divided_seconds - before, 0.03 * 0.99);
    EXPECT_LE(divided_seconds - before, took.count());
}

TEST(ThreadPoolTest, AvailableThreadsShareAJob) {
    ThreadPool pool(4);
    for (int job = 0; job < 500; ++job) {
        std::atomic<int> next = 0;
        std::vector<int> done(100);
        pool.share([&](int, int) {
            for (int i = next++; i < 100; i = next++) ++done[static_cast<size_t>(i)];
        });
        EXPECT_EQ(std::accumulate(done.begin(), done.end(), 0), 100);
    }
}

TEST(ThreadPoolTest, RethrowsAnExceptionOfAPartAndContinues) {
    ThreadPool pool(3);
    for (int job = 0; job < 100; ++job) {
        EXPECT_THROW(pool.run([&](int part, int) {
            if (part == job % 3) throw std::runtime_error("part");
        }),
                     std::runtime_error);
        int sum = 0;
        std::vector<int> parts(3);
        pool.run([&](int part, int) { parts[static_cast<size_t>(part)] = part; });
        sum = std::accumulate(parts.begin(), parts.end(), 0);
        EXPECT_EQ(sum, 3);
    }
}

TEST(ThreadPoolTest, AWorkerThatIsRefusedIsAnErrorAndEndsTheOthers) {
    for (int permitted = 0; permitted < 4; ++permitted) {
        const test::ThreadLimit limit(permitted);
        EXPECT_THROW(ThreadPool(5), std::runtime_error) << permitted;
    }
    const test::ThreadLimit limit(4);
    EXPECT_EQ(ThreadPool(5).size(), 5);
}

TEST(ThreadPoolTest, HundredsOfPoolsThatTakeTurnsHaveTheThreadsOfOne) {
    std::list<ThreadPool> pools;
    std::set<std::thread::id> threads;
    for (int i = 0; i < 300; ++i) expectWorks(pools.emplace_back(4, Threads::Shared));
    for (ThreadPool& pool : pools) addThreads(pool, threads);
    EXPECT_EQ(threads.size(), 4u);
    addThreads(pools.emplace_back(3, Threads::Shared), threads);  // another size
    addThreads(pools.emplace_back(4), threads);                   // its own
    EXPECT_EQ(threads.size(), 4u + 2u + 3u);
}

TEST(ThreadPoolTest, PoolsThatShareThreadsMayWorkAtTheSameTimeAndWithinEachOther) {
    std::vector<std::jthread> callers;
    for (int i = 0; i < 6; ++i)
        callers.emplace_back([&] {
            for (int job = 0; job < 50; ++job) {
                ThreadPool pool(3, Threads::Shared), inner(3, Threads::Shared);
                expectWorks(pool);
                std::atomic<int> parts = 0;
                pool.run([&](int part, int) {
                    if (part == 1) inner.run([&](int, int) { ++parts; });
                });
                EXPECT_EQ(parts, 3);
            }
        });
}

TEST(ThreadPoolTest, WhereTheSystemRefusesFurtherThreadsTheCallerDoesAllParts) {
    {
        const test::ThreadLimit limit(1);
        EXPECT_THROW(ThreadPool(3, Threads::Shared), std::runtime_error);
    }
    const test::ThreadLimit limit(2);
    ThreadPool first(3, Threads::Shared), second(3, Threads::Shared);
    expectWorks(first);
    first.run([&](int part, int) {
        if (part == 0) expectWorks(second);  // while the threads are busy
    });
}

}  // namespace
}  // namespace insonify::sonar
