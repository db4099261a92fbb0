// A process that is killed while it logs loses only unflushed samples.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <random>
#include <thread>

#include "components/log/Reader.hpp"
#include "components/logger/LogThread.hpp"
#include "tests/support/Folder.hpp"

namespace insonify::logger {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::duration<double> period(0.003);
constexpr size_t queue = 16;

/** The state of the logging process, in memory that outlives it. */
struct Reported {
    std::atomic<uint64_t> flushed = 0;   ///< Samples for which flush() has returned.
    std::atomic<uint64_t> pushed = 0;    ///< Samples for which push() has begun.
    std::atomic<uint64_t> max_late = 0;  ///< Samples written in one go after a flush was due.
};

/** A log that records when its samples are flushed. */
class WatchedLog final : public log::Writer {
public:
    WatchedLog(std::unique_ptr<log::Writer> log, Reported& reported) : log_(std::move(log)), reported_(reported) {}

    size_t add(size_t sample, const std::string& name, const log::Metadata& metadata) override {
        return log_->add(sample, name, metadata);
    }
    void put(size_t stream, types::Time received, types::Time time, types::SampleView sample) override {
        // A flush is due at most a period after this: the thread has read its clock after the previous flush.
        if (!due_) due_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(period);
        if (Clock::now() > *due_) reported_.max_late = std::max<uint64_t>(reported_.max_late, ++late_);
        log_->put(stream, received, time, sample);
    }
    size_t addLike(const log::Reader& log, size_t stream, const log::Metadata& more) override {
        return log_->addLike(log, stream, more);
    }
    void copy(size_t stream, log::Reader& log, const log::SampleRef& at) override { log_->copy(stream, log, at); }
    void flush() override {
        log_->flush();
        reported_.flushed = log_->kept();
        due_.reset();
        late_ = 0;
    }
    void sync() override { log_->sync(); }
    void close() override { log_->close(); }
    void next(std::filesystem::path path) override { log_->next(std::move(path)); }
    bool isOpen() const override { return log_->isOpen(); }
    const std::filesystem::path& path() const override { return log_->path(); }
    uint64_t size() const override { return log_->size(); }
    uint64_t kept() const override { return log_->kept(); }

private:
    std::unique_ptr<log::Writer> log_;
    Reported& reported_;
    std::optional<Clock::time_point> due_;
    uint64_t late_ = 0;
};

std::string toText(uint64_t number) {
    return std::to_string(number) + std::string(number * 7919 % 3000, static_cast<char>('a' + number % 26));
}

/** Logs numbered texts until it is killed. */
[[noreturn]] void logUntilKilled(const std::filesystem::path& path, Reported& reported) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    WatchedLog log(log::createLog(path), reported);
    LoggerConfig config;
    config.file = path.filename();
    Rotation rotation(config, log);
    LogThread thread(log, rotation, queue, period.count());
    const types::AnySample text = std::string();
    thread.declare([&](log::Writer& file) { return file.add(text.index(), "task.texts", {}); });
    for (uint64_t number = 0;; ++number) {
        reported.pushed = number + 1;
        thread.push(0, {static_cast<int64_t>(number + 1)}, types::AnySample(toText(number)));
    }
}

/** Kills the process at a random time, once it has flushed `least` samples. */
void killWhileLogging(const std::filesystem::path& path, uint64_t minimum, std::chrono::microseconds later,
                      Reported& reported) {
    const pid_t process = fork();
    if (process == 0) logUntilKilled(path, reported);
    int status = 0;
    while (reported.flushed < minimum) {
        ASSERT_EQ(waitpid(process, &status, WNOHANG), 0) << "it ended by itself";
        std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    std::this_thread::sleep_for(later);
    kill(process, SIGKILL);
    ASSERT_EQ(waitpid(process, &status, 0), process);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) << status;
}

/** Returns the number of samples in the log, which must be the first pushed samples, each complete. */
uint64_t samplesIn(const std::filesystem::path& path) {
    const auto log = log::openLog(path);
    uint64_t number = 0;
    log->forEach<std::string>("task.texts", [&](const std::string& text, const log::SampleRef&) {
        EXPECT_EQ(text, toText(number)) << number;
        ++number;
    });
    return number;
}

TEST(KilledLogTest, FiftyKillsLoseOnlyUnflushedSamples) {
    void* shared = mmap(nullptr, sizeof(Reported), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(shared, MAP_FAILED);
    std::minstd_rand random(9);
    for (int round = 0; round < 50; ++round) {
        SCOPED_TRACE(round);
        const Folder folder;
        const auto path = folder / (round % 2 == 0 ? "x.0.log" : "x.0.mcap");
        Reported& reported = *new (shared) Reported;
        killWhileLogging(path, 1 + random() % 200, std::chrono::microseconds(random() % 8000), reported);
        const uint64_t kept = samplesIn(path);
        EXPECT_GE(kept, reported.flushed);
        EXPECT_LE(kept, reported.pushed);
        // With a flush each `period`, at most a second, and one further sample while a flush is due, the lost samples
        // are those written since the last flush and those waiting in the queue.
        EXPECT_LE(reported.max_late, 1u);
    }
    munmap(shared, sizeof(Reported));
}

}  // namespace
}  // namespace insonify::logger
