#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>

#include "components/sonar/base/ThreadPool.hpp"
#include "tests/support/ThreadLimit.hpp"

namespace insonify::sonar {
namespace {

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

}  // namespace
}  // namespace insonify::sonar
