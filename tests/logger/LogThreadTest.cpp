#include <gtest/gtest.h>

#include <atomic>

#include "components/logger/LogThread.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::logger {
namespace {

/** A log that writes nothing, and waits with its first sample until it may continue. */
struct StandingLog : log::Writer {
    std::atomic<bool> may_continue{false};
    std::atomic<int> put_samples{0}, flushes{0}, syncs{0};
    size_t add(size_t, const std::string&, const log::Metadata&) override { return 0; }
    void put(size_t, types::Time, types::Time, types::SampleView) override {
        test::becomesTrue([&] { return may_continue.load(); });
        ++put_samples;
    }
    size_t addLike(const log::Reader&, size_t, const log::Metadata&) override { return 0; }
    void copy(size_t, log::Reader&, const log::SampleRef&) override {}
    void flush() override { ++flushes; }
    void sync() override { ++syncs; }
    void close() override {}
    void next(std::filesystem::path) override {}
    bool isOpen() const override { return true; }
    const std::filesystem::path& path() const override { return path_; }
    uint64_t size() const override { return 0; }
    uint64_t kept() const override { return 0; }

private:
    std::filesystem::path path_ = "x.0.log";
};

TEST(LogThreadTest, LargeSamplesFillTheQueueByTheirSize) {
    constexpr size_t ping_bytes = 8 << 20;
    StandingLog log;
    Rotation rotation({}, log);
    LogThread thread(log, rotation, 1000, 1);
    std::atomic<int> pushed{0};
    constexpr int all = 80;
    std::thread source([&] {
        for (int i = 0; i < all; ++i) {
            const auto ping = std::make_shared<types::Sonar>();
            ping->bins.resize(ping_bytes / sizeof(float));
            thread.push(0, {}, types::SonarPtr(ping));
            ++pushed;
        }
    });
    constexpr int bound = LogThread::max_bytes / ping_bytes;
    EXPECT_TRUE(test::becomesTrue([&] { return pushed >= bound - 1; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_LE(pushed, bound);
    log.may_continue = true;
    source.join();
    thread.finish();
    EXPECT_EQ(log.put_samples, all);
}

TEST(LogThreadTest, SmallSamplesFillItByTheirNumber) {
    StandingLog log;
    Rotation rotation({}, log);
    LogThread thread(log, rotation, 20, 1);
    std::atomic<int> pushed{0};
    std::thread source([&] {
        for (int i = 0; i < 100; ++i) thread.push(0, {}, 1.0), ++pushed;
    });
    EXPECT_TRUE(test::becomesTrue([&] { return pushed == 20; }));
    log.may_continue = true;
    source.join();
    thread.finish();
    EXPECT_EQ(log.put_samples, 100);
}

TEST(LogThreadTest, SyncsInItsPeriodAndNotWithoutOne) {
    for (const bool does_sync : {false, true}) {
        StandingLog log;
        log.may_continue = true;
        Rotation rotation({}, log);
        LogThread thread(log, rotation, 20, 0.001, AtFailure::Throw, does_sync ? 0.01 : 1e9);
        EXPECT_TRUE(test::becomesTrue([&] { return log.flushes > 20 && (!does_sync || log.syncs > 3); }));
        thread.finish();
        EXPECT_EQ(log.syncs > 0, does_sync);
    }
}

}  // namespace
}  // namespace insonify::logger
