// Logs of several files.
#include <gmock/gmock.h>

#include <map>
#include <numeric>

#include "components/log/Files.hpp"
#include "components/log/pocolog/Reader.hpp"
#include "components/log/pocolog/Writer.hpp"
#include "components/logger/LogThread.hpp"
#include "components/logger/LoggerTask.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::logger {
namespace {

struct RotationTest : testing::Test {
    /** Logs texts of 100 kB at intervals of 0.1 s to x.0.log and the following files. */
    void log(LoggerConfig config, int count, const std::string& name = "x.0.log") {
        config.file = name;
        LoggerTask task("log");
        task.config.set(config);
        task.environment().output_folder = folder.path();
        types::Time now{5'000'000};
        task.environment().now = [&] { return now; };
        test::Writer<std::string> source("source");
        source.port.connectTo(*task.makeInput("text", source.port), framework::ConnPolicy::buffer(8));
        test::Writer<double> silent("silent");
        silent.port.connectTo(*task.makeInput("silent", silent.port), framework::ConnPolicy::buffer(8));
        ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
        for (int i = 0; i < count; ++i) {
            source.port.write(std::to_string(i) + std::string(100'000, ' '));
            task.update();
            now = now + types::Time{100'000};
            if (i + 1 == set_back_at) now = now + step;
        }
        ASSERT_TRUE(task.stop());
        ASSERT_TRUE(task.cleanup());
    }
    std::filesystem::path file(int number) const { return folder / ("x." + std::to_string(number) + ".log"); }
    /** Returns the samples of each file, which must be valid and have consecutive numbers. */
    std::vector<size_t> getCounts(int files) const {
        std::vector<size_t> counts;
        int expected = 0;
        for (int number = 0; number < files; ++number) {
            const log::Verdict verdict = log::check(file(number));
            EXPECT_FALSE(verdict.diagnostic) << verdict.diagnostic->message;
            EXPECT_TRUE(std::filesystem::exists(folder / ("x." + std::to_string(number) + ".idx")));
            log::pocolog::Reader log(file(number));
            log.forEach<std::string>("source.port", [&](const std::string& text, const log::SampleRef&) {
                EXPECT_EQ(std::stoi(text), expected++);
            });
            counts.push_back(log.samples().size());
        }
        EXPECT_FALSE(std::filesystem::exists(file(files)));
        return counts;
    }
    const Folder folder;
    int set_back_at = -1;  ///< Number of samples before the clock is set.
    types::Time step{};
};

TEST_F(RotationTest, ALoggerThatNeverStartsLeavesTheFilesOfAnEarlierRun) {
    LoggerConfig config;
    config.max_file_size = 1e6;
    log(config, 25);
    std::map<std::filesystem::path, std::vector<char>> before;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        before[entry.path()] = toBytes(entry.path());
    ASSERT_GT(before.size(), 5u);
    for (const char* file : {"x.0.log", "new.0.log", "new.0.mcap"})
        for (const bool is_cleaned_up : {true, false}) {
            LoggerTask task("log");
            config.file = file;
            task.config.set(config);
            task.environment().output_folder = folder.path();
            test::Writer<std::string> source("source");
            source.port.connectTo(*task.makeInput("text", source.port), framework::ConnPolicy::buffer(8));
            ASSERT_TRUE(task.configure()) << task.lastError();
            if (is_cleaned_up) {
                ASSERT_TRUE(task.cleanup());
            }
        }
    for (const auto& [file, bytes] : before) EXPECT_TRUE(toBytes(file) == bytes) << file;
    EXPECT_EQ(static_cast<size_t>(std::distance(std::filesystem::directory_iterator(folder.path()), {})),
              before.size());
}

TEST_F(RotationTest, AFullFileIsFollowedByTheNext) {
    LoggerConfig config;
    config.max_file_size = 1e6;
    log(config, 25);
    EXPECT_THAT(getCounts(3), testing::ElementsAre(10, 10, 5));
    EXPECT_LT(std::filesystem::file_size(file(0)), 1.11e6) << "the limit and one sample";
    EXPECT_NE(log::pocolog::Reader(file(2)).find("silent.port"), nullptr) << "declared at the end of the last file";
}

TEST_F(RotationTest, AnOldFileIsFollowedByTheNext) {
    LoggerConfig config;
    config.max_file_duration = 1;
    log(config, 25);
    EXPECT_THAT(getCounts(3), testing::ElementsAre(10, 10, 5));
}

TEST_F(RotationTest, WithoutALimitThereIsOneFile) {
    log({}, 25);
    EXPECT_THAT(getCounts(1), testing::ElementsAre(25));
}

TEST_F(RotationTest, TheFirstFileStandsForAllOfTheSameRun) {
    LoggerConfig config;
    config.max_file_size = 1e6;
    log(config, 45);
    const auto numbersIn = [&](int first) {
        const log::WholeLog whole = log::openWholeLog(file(first));
        std::vector<int> numbers;
        whole.log->forEach<std::string>(
            "source.port", [&](const std::string& text, const log::SampleRef&) { numbers.push_back(std::stoi(text)); });
        EXPECT_EQ(whole.files.front(), file(first));
        EXPECT_EQ(whole.log->path(), file(first));
        EXPECT_EQ(whole.notice.empty(), whole.files.size() == 1);
        return numbers;
    };
    std::vector<int> all(45);
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(numbersIn(0), all);
    EXPECT_EQ(numbersIn(2), std::vector<int>(all.begin() + 20, all.begin() + 30)) << "alone, as before";
    EXPECT_THAT(log::openWholeLog(file(0)).notice,
                testing::HasSubstr("x.0.log is continued in 4 files up to x.4.log, which are taken with it"));
    std::filesystem::remove(file(0));
    std::filesystem::remove(file(2));
    std::vector<int> left(all.begin() + 10, all.begin() + 20);
    left.insert(left.end(), all.begin() + 30, all.end());
    EXPECT_EQ(numbersIn(1), left) << "the first of those that are there, also after a missing number";
    {
        log::pocolog::Writer other(file(5));
        const size_t stream = other.addStream<double>("source.other", {{"insonify_seed", "7"}});
        other.write(stream, types::Time{1}, 1.0);
        other.close();
    }
    EXPECT_EQ(numbersIn(1), left) << "without a file of another run";
    EXPECT_THAT(log::openWholeLog(file(1)).notice,
                testing::AllOf(testing::HasSubstr("up to x.4.log"), testing::HasSubstr("x.5.log is of another run")));
}

TEST_F(RotationTest, AQuotaKeepsTheNewestFiles) {
    for (const bool is_mcap : {false, true})
        for (const double quota : {2e6, 3e6, 4.5e6}) {
            SCOPED_TRACE(quota);
            LoggerConfig config;
            config.max_file_size = 1e6;
            config.max_total_size = quota;
            log(config, 75, is_mcap ? "bag/x.0.mcap" : "x.0.log");
            const auto first = folder / (is_mcap ? "bag/x.0.mcap" : "x.0.log");
            const auto files = log::findSequence(first);
            ASSERT_FALSE(files.empty());
            uintmax_t total = 0;
            for (const auto& [number, path] : files) total += std::filesystem::file_size(path);
            EXPECT_LE(static_cast<double>(total), quota + 0.11e6 * static_cast<double>(files.size()))
                << "and a sample each";
            EXPECT_GE(static_cast<double>(total), quota - 1.11e6) << "no file is removed before it must";
            EXPECT_EQ(files.rbegin()->first, 7u);
            EXPECT_EQ(files.size(), files.rbegin()->first - files.begin()->first + 1);
            std::vector<std::string> kept;
            log::openWholeLog(files.begin()->second)
                .log->forEach<std::string>("source.port", [&](const std::string& text, const log::SampleRef&) {
                    kept.push_back(text.substr(0, text.find(' ')));
                });
            EXPECT_EQ(kept.front(), std::to_string(10 * files.begin()->first));
            EXPECT_EQ(kept.back(), "74");
            if (!is_mcap)
                for (unsigned number = 0; number < files.begin()->first; ++number)
                    EXPECT_FALSE(std::filesystem::exists(log::pocolog::indexPath(file(static_cast<int>(number)))));
            else
                EXPECT_EQ(log::openLog(folder / "bag")->samples().size(), kept.size()) << "metadata.yaml lists them";
        }
}

TEST_F(RotationTest, RemovesFilesOfAnEarlierLongerLogWithTheirIndices) {
    LoggerConfig config;
    config.max_file_size = 1e6;
    log(config, 45);
    EXPECT_TRUE(std::filesystem::exists(file(4)));
    log(config, 15);
    EXPECT_THAT(getCounts(2), testing::ElementsAre(10, 5));
    for (int number = 2; number < 5; ++number) {
        EXPECT_FALSE(std::filesystem::exists(file(number)));
        EXPECT_FALSE(std::filesystem::exists(log::pocolog::indexPath(file(number))));
    }
}

TEST_F(RotationTest, RemovesFilesOfAnEarlierLongerLogWithoutALimit) {
    LoggerConfig config;
    config.max_file_size = 1e6;
    log(config, 25);
    log({}, 15);
    EXPECT_THAT(getCounts(1), testing::ElementsAre(15));
    for (int number = 1; number < 3; ++number) {
        EXPECT_FALSE(std::filesystem::exists(file(number)));
        EXPECT_FALSE(std::filesystem::exists(log::pocolog::indexPath(file(number))));
    }
}

TEST_F(RotationTest, RemovesNothingIfAnotherLoggerWritesOneOfTheFiles) {
    writeBytes(file(0), {'o', 'l', 'd'});
    writeBytes(file(1), {'o', 'l', 'd'});
    const log::pocolog::Writer other(file(2));
    for (const std::optional<double> limit : {std::optional<double>(), std::optional<double>(1e6)}) {
        LoggerTask task("log");
        LoggerConfig config;
        config.file = "x.0.log";
        config.max_file_size = limit;
        task.config.set(config);
        task.environment().output_folder = folder.path();
        EXPECT_FALSE(task.configure());
        ASSERT_NE(task.configError(), nullptr);
        EXPECT_THAT(task.configError()->what(), testing::HasSubstr("another logger writes it"));
        EXPECT_THAT(task.configError()->what(), testing::HasSubstr("x.2.log"));
    }
    EXPECT_EQ(toBytes(file(0)).size(), 3u);
    EXPECT_EQ(toBytes(file(1)).size(), 3u);
    EXPECT_TRUE(std::filesystem::exists(file(2)));
}

TEST_F(RotationTest, RemovesFilesOfAnEarlierLogAfterAMissingNumber) {
    LoggerConfig config;
    config.max_file_size = 1e6;
    log(config, 45);
    std::filesystem::remove(file(1));
    for (const char* other : {"x.7.mcap", "y.8.log", "x.notes.log", "x.log"}) writeBytes(folder / other, {'x'});
    log(config, 5);
    EXPECT_THAT(getCounts(1), testing::ElementsAre(5));
    for (int number = 1; number < 5; ++number) EXPECT_FALSE(std::filesystem::exists(file(number))) << number;
    for (const char* other : {"x.7.mcap", "y.8.log", "x.notes.log", "x.log"})
        EXPECT_TRUE(std::filesystem::exists(folder / other)) << other;
}

/** Pushes texts of 100 kB to a log that heals, with files of a megabyte. */
void pushTexts(const std::filesystem::path& path, int count, const std::function<void(int)>& at) {
    LoggerConfig config;
    config.file = path.filename();
    config.max_file_size = 1e6;
    const auto log = log::createLog(path);
    Rotation rotation(config, *log);
    LogThread thread(*log, rotation, 1, 0.001, AtFailure::Heal);
    const types::AnySample text = std::string(100'000, 'x');
    thread.declare([&](log::Writer& file) { return file.add(text.index(), "texts", {}); });
    for (int i = 0; i < count; ++i) {
        at(i);
        thread.push(0, {}, text);
    }
    test::becomesTrue([&] { return !thread.health().fails; });
    thread.finish();
    log->close();
}

TEST_F(RotationTest, AFileThatCannotBeOpenedForAWhileIsTheNextOneStill) {
    pushTexts(file(0), 30, [&](int i) {
        if (i == 0) std::filesystem::create_symlink("nowhere/x", file(1));
        if (i == 15) std::filesystem::remove(file(1));
    });
    EXPECT_TRUE(std::filesystem::is_regular_file(file(1)));
    EXPECT_FALSE(log::check(file(1)).diagnostic);
}

TEST_F(RotationTest, AFolderWithTheNameOfTheNextFileIsPassedOver) {
    std::filesystem::create_directory(file(1));
    pushTexts(file(0), 15, [](int) {});
    EXPECT_TRUE(std::filesystem::is_regular_file(file(2)));
    EXPECT_FALSE(log::check(file(2)).diagnostic);
}

TEST_F(RotationTest, AClockThatIsSetEndsAFileWithADurationAndFilesAreOfTheirDurationThen) {
    LoggerConfig config;
    config.max_file_duration = 1;
    for (const double seconds : {-4.0, -600.0, 600.0}) {
        set_back_at = 15;
        step = types::Time::fromSeconds(seconds);
        log(config, 40);
        EXPECT_THAT(getCounts(5), testing::ElementsAre(10, 5, 10, 10, 5)) << seconds;
    }
}

}  // namespace
}  // namespace insonify::logger
