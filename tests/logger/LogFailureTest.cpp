// Full disks and missing folders.
#include <gmock/gmock.h>

#include <chrono>
#include <thread>

#include "components/log/pocolog/Reader.hpp"
#include "components/logger/LogThread.hpp"
#include "components/logger/LoggerTask.hpp"
#include "tests/logger/LimitedDisk.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::logger {
namespace {

using framework::ConnPolicy;
using framework::TaskState;

LoggerConfig configFor(const std::string& file) {
    LoggerConfig config;
    config.file = file;
    config.flush_period = 0.001;
    return config;
}

std::string thousandBytes() { return std::string(1000, 'x'); }

TEST(LogFailureTest, AFolderThatCannotBeMadeRefusesConfigure) {
    Folder folder;
    writeBytes(folder / "file", {'x'});
    LoggerTask task("log");
    task.environment().output_folder = folder / "file";
    task.config.set(configFor("x.0.log"));
    EXPECT_FALSE(task.configure());
    ASSERT_NE(task.configError(), nullptr);
    EXPECT_THAT(task.configError()->what(), testing::HasSubstr((folder / "file").string()));
}

TEST(LogFailureTest, AFileThatCannotBeOpenedRefusesConfigure) {
    Folder folder;
    std::filesystem::create_directory(folder / "x.0.log");
    LoggerTask task("log");
    task.environment().output_folder = folder.path();
    task.config.set(configFor("x.0.log"));
    EXPECT_FALSE(task.configure());
    ASSERT_NE(task.configError(), nullptr);
    EXPECT_THAT(task.configError()->what(), testing::HasSubstr("cannot be written"));
}

TEST(LogFailureTest, AFullDiskEndsInExceptionWithTheSystemsReason) {
    Folder folder;
    std::filesystem::create_symlink("/dev/full", folder / "x.0.log");
    LoggerTask task("log");
    task.environment().output_folder = folder.path();
    task.config.set(configFor("x.0.log"));
    test::Writer<std::string> source;
    source.port.connectTo(*task.makeInput("in", source.port), ConnPolicy::buffer(10));
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    logUntilFailure(task, source, thousandBytes);
    EXPECT_EQ(task.state(), TaskState::Exception);
    EXPECT_THAT(task.lastError(), testing::HasSubstr("No space left on device"));
}

TEST(LogFailureTest, CountsTheSamplesThatDidNotReachTheDisk) {
    Folder folder;
    std::filesystem::create_symlink("/dev/full", folder / "x.0.log");
    const auto log = log::createLog(folder / "x.0.log");
    Rotation rotation(configFor("x.0.log"), *log);
    const double never = 3600;
    LogThread thread(*log, rotation, 10, never);
    const types::AnySample text = std::string("x");
    thread.declare([&](log::Writer& file) { return file.add(text.index(), "texts", {}); });
    for (int i = 0; i < 3; ++i) thread.push(0, {}, text);
    EXPECT_THAT([&] { thread.finish(); },
                testing::ThrowsMessage<std::runtime_error>(testing::HasSubstr("3 samples did not reach it")));
}

TEST(LogFailureTest, StopReportsADiskThatIsFullAtTheEnd) {
    Folder folder;
    std::filesystem::create_symlink("/dev/full", folder / "x.0.log");
    LoggerTask task("log");
    task.environment().output_folder = folder.path();
    LoggerConfig config = configFor("x.0.log");
    config.flush_period = 1;
    task.config.set(config);
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    EXPECT_FALSE(task.stop());
    EXPECT_EQ(task.state(), TaskState::Exception);
    EXPECT_THAT(task.lastError(), testing::HasSubstr("No space left on device"));
}

TEST(LogFailureTest, KeepsFlushedSamplesOnAFullDisk) {
    Folder folder;
    EXPECT_EXIT(fillLimitedDisk(folder / "x.0.log", thousandBytes), testing::ExitedWithCode(0), "");
    log::pocolog::Reader log(folder / "x.0.log");
    EXPECT_TRUE(log.complete()) << log.diagnostic();
    EXPECT_GT(log.samples().size(), 5u);
    log.forEach<std::string>("writer.port",
                             [](const std::string& text, const log::SampleRef&) { EXPECT_EQ(text.size(), 1000u); });
}

/** Pushes texts to a thread that heals, until a condition is met. */
class Pushing {
public:
    explicit Pushing(const std::filesystem::path& file)
        : log_(log::createLog(file)), config_(configFor(file.filename())) {
        declare("a.texts");
    }
    void declare(const char* name) {
        thread_.declare([this, name](log::Writer& file) { return file.add(text_.index(), name, {}); });
    }
    bool until(size_t stream, auto&& done) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (!done() && std::chrono::steady_clock::now() < end) {
            thread_.push(stream, types::Time{static_cast<int64_t>(++pushed)}, text_);
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return done();
    }
    void finish() { thread_.finish(); }
    void close() { log_->close(); }
    LogHealth health() const { return thread_.health(); }

    uint64_t pushed = 0;

private:
    const types::AnySample text_ = thousandBytes();
    std::unique_ptr<log::Writer> log_;
    LoggerConfig config_;
    Rotation rotation_{config_, *log_};
    LogThread thread_{*log_, rotation_, 10, 0.001, AtFailure::Heal};
};

size_t textsIn(const std::filesystem::path& file) { return log::openLog(file)->samples().size(); }

TEST(LogFailureTest, AHealingLogContinuesWhenThereIsSpaceAndCountsItsLosses) {
    const Folder folder;
    std::filesystem::create_symlink("/dev/full", folder / "x.0.log");
    Pushing pushing(folder / "x.0.log");
    ASSERT_TRUE(pushing.until(0, [&] { return pushing.health().fails && pushing.pushed > 20; }));
    EXPECT_THAT(pushing.health().failure, testing::HasSubstr("No space left on device"));
    pushing.declare("b.texts");
    const uint64_t before = pushing.pushed;
    ASSERT_TRUE(pushing.until(1, [&] { return pushing.pushed > before + 10; }));
    std::filesystem::remove(folder / "x.0.log");  // frees space
    ASSERT_TRUE(pushing.until(1, [&] { return !pushing.health().fails; }));
    const LogHealth healed = pushing.health();
    const uint64_t over = pushing.pushed;
    ASSERT_TRUE(pushing.until(0, [&] { return pushing.pushed > over + 100; }));
    pushing.finish();
    pushing.close();
    EXPECT_EQ(healed.outages, 1u);
    EXPECT_GE(healed.lost, 30u);
    EXPECT_EQ(healed.file, folder / "x.0.log") << "it was empty";
    EXPECT_EQ(textsIn(healed.file) + healed.lost, pushing.pushed) << "each is in the file or counted";
    const auto written = log::openLog(healed.file);
    ASSERT_NE(written->find("b.texts"), nullptr) << "a stream declared in the outage";
    EXPECT_GT(written->find("a.texts")->count, 90u);
}

TEST(LogFailureTest, ADiskThatStaysFullIsAnErrorAtTheEndWithoutDelays) {
    const Folder folder;
    std::filesystem::create_symlink("/dev/full", folder / "x.0.log");
    Pushing pushing(folder / "x.0.log");
    ASSERT_TRUE(pushing.until(0, [&] { return pushing.pushed == 1000; }));
    EXPECT_THAT([&] { pushing.finish(); },
                testing::ThrowsMessage<std::runtime_error>(testing::HasSubstr("1000 samples did not reach it")));
}

/** Files of at most 20000 bytes, one after the other: returns whether each text is in a file or counted as lost. */
[[noreturn]] void logIntoSmallFiles(const std::filesystem::path& folder, const std::string& extension) {
    const rlimit limit{20000, 20000};
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_IGN);
    Pushing pushing(folder / ("x.0" + extension));
    const bool healed_twice = pushing.until(0, [&] { return pushing.health().outages == 3; });
    pushing.finish();
    try {
        pushing.close();
    } catch (const std::exception&) {
        // The index may not fit; flushed samples stay.
    }
    size_t kept = 0, files = 0;
    for (; std::filesystem::exists(folder / ("x." + std::to_string(files) + extension)); ++files)
        kept += textsIn(folder / ("x." + std::to_string(files) + extension));
    std::_Exit(healed_twice && files >= 3 && kept > 20 && kept + pushing.health().lost == pushing.pushed ? 0 : 1);
}

TEST(LogFailureTest, EachSampleIsInOneOfTheFilesOrCounted) {
    const Folder rock, ros;
    EXPECT_EXIT(logIntoSmallFiles(rock.path(), ".log"), testing::ExitedWithCode(0), "");
    EXPECT_EXIT(logIntoSmallFiles(ros.path(), ".mcap"), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace insonify::logger
