// Logs of a run whose clock was set while it wrote them.
#include <gmock/gmock.h>

#include <fstream>

#include "components/log/Copy.hpp"
#include "components/log/Files.hpp"
#include "components/log/Reader.hpp"
#include "components/log/pocolog/Reader.hpp"
#include "components/log/pocolog/Writer.hpp"
#include "tests/support/Folder.hpp"

namespace insonify::log {
namespace {

using testing::ElementsAre;
using types::Time;

Time at(double seconds) { return Time::fromSeconds(seconds); }

struct SetClockTest : testing::Test {
    /** Logs poses that are received as they are stamped [s]. */
    void write(std::initializer_list<double> times) const {
        const auto log = makeWriter();
        const size_t stream = log->addStream<types::Pose>("a.b");
        for (const double time : times) {
            types::Pose pose;
            pose.time = at(time);
            log->write(stream, pose.time, pose);
        }
        log->close();
    }
    std::unique_ptr<pocolog::Writer> makeWriter() const { return std::make_unique<pocolog::Writer>(file_); }
    std::vector<double> timesIn(const Reader& log) const {
        std::vector<double> times;
        for (const SampleRef& sample : log.samples()) times.push_back(sample.time.seconds());
        return times;
    }

    Folder folder_;
    const std::filesystem::path file_ = folder_ / "x.0.log";
};

TEST_F(SetClockTest, EachSampleKeepsItsTime) {
    write({10, 5, 6});
    const pocolog::Reader log(file_);
    EXPECT_THAT(timesIn(log), ElementsAre(10, 5, 6));
    EXPECT_EQ(log.samples()[1].received, at(5));
    EXPECT_EQ(log.streams()[0].set_backs, 1u);
    EXPECT_EQ(log.streams()[0].set_back, at(5));
    EXPECT_EQ(log.streams()[0].rate(), 2) << "two intervals in a second, the step takes no time";
}

TEST_F(SetClockTest, AStampInTheFarFutureDoesNotFreezeItsStream) {
    write({1, 4e9, 2, 3});
    EXPECT_THAT(timesIn(pocolog::Reader(file_)), ElementsAre(1, 4e9, 2, 3));
}

TEST_F(SetClockTest, ALateSampleHasTheTimeOfTheOneBefore) {
    write({10, 9.5, 9, 11});
    const pocolog::Reader log(file_);
    EXPECT_THAT(timesIn(log), ElementsAre(10, 10, 10, 11)) << "readers search by these times";
    EXPECT_EQ(log.streams()[0].set_backs, 0u);
    EXPECT_FALSE(check(file_).diagnostic);
}

TEST_F(SetClockTest, TheIndexHasNoNegativeOffsets) {
    write({10, 5, 6});
    std::ifstream file(pocolog::indexPath(file_), std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    const auto number = [&](size_t byte) {
        uint64_t value = 0;
        for (size_t i = 0; i < 8; ++i) value = value << 8 | static_cast<uint8_t>(bytes[byte + i]);
        return value;
    };
    constexpr size_t stream = 13 + 4 + 3 * 8;  // of the first stream, after the prologue
    ASSERT_EQ(bytes.size(), stream + 8 * 8 + 3 * 16);
    EXPECT_EQ(number(stream + 16), 5'000'000u) << "the earliest";
    EXPECT_EQ(number(stream + 48), 5'000'000u);
    EXPECT_EQ(number(stream + 56), 10'000'000u);
    const uint64_t offsets[] = {5'000'000, 0, 1'000'000};
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(number(stream + 64 + 16 * i + 8), offsets[i]);
}

TEST_F(SetClockTest, TheStrictReaderCountsTheSteps) {
    write({10, 5, 6, 2, 2.5, 9, 1});
    const Verdict verdict = check(file_);
    EXPECT_FALSE(verdict.diagnostic) << verdict.diagnostic->message;
    EXPECT_EQ(verdict.samples, 7u);
    EXPECT_EQ(verdict.set_backs, 3u);
}

TEST_F(SetClockTest, ACutByTimeHasTheSamplesOfThatTimeFromBeforeAndAfterTheStep) {
    write({10, 11, 12, 5, 11.5, 13});
    Selection selection;
    selection.from = at(11);
    selection.until = at(13);
    copyLog({file_}, folder_ / "y.0.log", {.selection = selection});
    EXPECT_THAT(timesIn(pocolog::Reader(folder_ / "y.0.log")), ElementsAre(11, 12, 12));
    copyLog({file_}, folder_ / "z.0.log", {});
    EXPECT_THAT(timesIn(pocolog::Reader(folder_ / "z.0.log")), ElementsAre(10, 11, 12, 5, 11.5, 13));
}

TEST(LoggerClockTest, TimesContinueOverStepsBack) {
    std::vector<SampleRef> samples;
    const auto add = [&](double received, double time) {
        samples.push_back({0, at(received), at(time), 0, samples.size()});
    };
    add(100, 99.9);
    add(101, 101);
    add(50, 49.9);     // the clock was set back
    add(50.1, 101.3);  // of before that
    add(50.5, 50.5);
    add(50.4, 50.4);  // late, no step
    add(20, 20);
    add(900, 900);  // a pause, or a step forward
    const LoggerClock clock(samples);
    std::vector<double> times;
    for (const SampleRef& sample : samples) times.push_back(clock.evenTime(sample).seconds());
    const auto near = [](double value) { return testing::DoubleNear(value, 1e-6); };
    EXPECT_THAT(times, ElementsAre(near(99.9), near(101), near(101.9), near(101.3), near(102.5), near(102.4),
                                   near(102.4), near(982.4)));
}

}  // namespace
}  // namespace insonify::log
