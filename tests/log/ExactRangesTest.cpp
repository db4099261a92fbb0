// Ranges of bins that are not whole microseconds, through logs.
#include <gtest/gtest.h>

#include <random>

#include "components/log/Copy.hpp"
#include "components/log/Files.hpp"
#include "components/log/Stream.hpp"
#include "components/log/Writer.hpp"
#include "components/log/mcap/Reader.hpp"
#include "components/log/pocolog/Reader.hpp"
#include "components/log/pocolog/Wire.hpp"
#include "tests/support/Folder.hpp"

namespace insonify::log {
namespace {

struct Written {
    types::Sonar ping;
    types::SonarTruth truth;
};

Written bins(double width, double speed) {
    Written made;
    made.ping.time = {1};
    made.ping.setBins(width, speed);
    made.ping.resize(400, 1);
    made.ping.bearings = {types::Angle::fromDeg(3)};
    made.truth.copyGrid(made.ping);
    std::ranges::fill(made.truth.object, types::SonarTruth::no_object);
    return made;
}

void write(const Written& made, const std::filesystem::path& path) {
    const auto log = createLog(path);
    Metadata metadata;
    addSampleMetadata(&made.ping, metadata);
    log->write(log->addStream<types::Sonar>("sonar.ping", metadata), {}, made.ping);
    log->write(log->addStream<types::SonarTruth>("sonar.truth", metadata), {}, made.truth);
    log->close();
}

void expectSame(const std::filesystem::path& path, const Written& made) {
    const auto log = openLog(path);
    const auto check = [&](const types::RangeBins& read, const types::RangeBins& written) {
        EXPECT_EQ(read.binWidth(), written.binWidth()) << path;
        EXPECT_EQ(read.speed_of_sound, written.speed_of_sound) << path;
        EXPECT_EQ(read.bin_duration, written.bin_duration) << path;
    };
    log->forEach<types::Sonar>("sonar.ping", [&](const auto& ping, const auto&) { check(ping, made.ping); });
    log->forEach<types::SonarTruth>("sonar.truth", [&](const auto& truth, const auto&) { check(truth, made.truth); });
}

TEST(ExactRangesTest, EndingsInAnyCaseOfLettersAreTheSameFormat) {
    const Folder folder;
    const Written made = bins(0.013, 1500);
    for (const std::string ending : {"log", "LOG", "Log", "mcap", "MCAP", "mCaP"}) {
        const std::filesystem::path inside = folder / ending;  // a bag has a folder of its own
        std::filesystem::create_directory(inside);
        write(made, inside / ("x.0." + ending));
        const auto log = openLog(inside / ("x.0." + ending));
        const bool is_mcap = ending.size() == 4;
        EXPECT_EQ(dynamic_cast<mcap::Reader*>(log.get()) != nullptr, is_mcap) << ending;
        EXPECT_EQ(dynamic_cast<pocolog::Reader*>(log.get()) != nullptr, !is_mcap) << ending;
        EXPECT_EQ(isMcap("a." + ending), is_mcap);
        expectSame(inside / ("x.0." + ending), made);
        EXPECT_FALSE(check(inside / ("x.0." + ending)).diagnostic) << ending;
    }
    for (const char* other : {"x", "x.log.gz", "x.mcap2", ".log", "x."}) EXPECT_EQ(findLogFormat(other), nullptr);
    EXPECT_EQ(logEndings(), ".log or .mcap");
}

TEST(ExactRangesTest, LogsOfEitherFormatKeepWidthAndSpeedOfSound) {
    const Folder folder, copies;  // a bag has a folder of its own
    std::mt19937 random(2);
    std::uniform_real_distribution<double> exponent(-4, 0), speed(1400, 1600);
    for (int i = 0; i < 30; ++i) {
        const Written made = bins(std::pow(10, exponent(random)), speed(random));
        SCOPED_TRACE(made.ping.binWidth());
        for (const char* name : {"x.0.log", "x.mcap"}) {
            write(made, folder / name);
            expectSame(folder / name, made);
            for (const char* copy : {"copy.0.log", "copy.mcap"}) {
                if (std::string_view(copy).ends_with("mcap") != std::string_view(name).ends_with("mcap")) {
                    copyLog({folder / name}, copies / copy);
                    expectSame(copies / copy, made);
                }
            }
        }
    }
}

TEST(ExactRangesTest, RocksOwnReadersGetTheRanges) {
    const Written made = bins(0.0001, 1500);  // 0.07 us
    std::vector<char> bytes;
    pocolog::marshal(made.ping, bytes);
    types::Sonar read;
    pocolog::unmarshal(bytes, read);
    EXPECT_EQ(read.bin_width, 0);
    EXPECT_EQ(read.bin_duration.microseconds, 1);
    EXPECT_NEAR(read.binStart(400), 0.04, 1e-8);
    EXPECT_NEAR(read.speed_of_sound, 100, 1e-5);
}

TEST(ExactRangesTest, ARangeThatChangesLaterIsExactToo) {
    const Folder folder;
    const Written first = bins(0.005, 1500), second = bins(0.0064, 1480);
    const auto log = createLog(folder / "x.0.log");
    Metadata metadata;
    addSampleMetadata(&first.ping, metadata);
    const size_t stream = log->addStream<types::Sonar>("sonar.ping", metadata);
    for (const Written* made : {&first, &second, &first}) log->write(stream, {}, made->ping);
    log->close();
    std::vector<double> ranges;
    openLog(folder / "x.0.log")->forEach<types::Sonar>("sonar.ping", [&](const auto& ping, const auto&) {
        ranges.push_back(ping.binStart(400));
    });
    ASSERT_EQ(ranges.size(), 3u);
    EXPECT_EQ(ranges[0], 2);
    EXPECT_NEAR(ranges[1], 2.56, 1e-6);
    EXPECT_EQ(ranges[2], 2);
}

}  // namespace
}  // namespace insonify::log
