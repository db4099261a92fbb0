// Replays of logs whose logger's clock was set, and of a log with a gap: `seek`, `from`, the span and the position go
// by the time without the steps back.
#include <gmock/gmock.h>

#include "tests/replay/Bench.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::replay {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr int64_t log_second = 1'000'000;                  // [us]
constexpr int64_t log_start = 1'600'000'000 * log_second;  // on its first clock [us]
constexpr double clock_step = 600;                         // [s]

/** A log of 60 poses 1 s apart. Pose i was taken at i seconds, by a clock that was `offset(i)` seconds ahead. */
struct Recorded {
    explicit Recorded(const std::function<double(int)>& offset, ReplayConfig config = {}) : bench(true, config) {
        log::pocolog::Writer log(bench.folder / "x.0.log");
        const size_t stream = log.addStream<types::Pose>("vehicle.pose");
        for (int i = 0; i < 60; ++i) {
            types::Pose pose;
            pose.time = types::Time{log_start} + types::Time::fromSeconds(i + offset(i));
            pose.position.x = i;
            log.write(stream, pose.time, pose);
        }
        log.close();
    }
    void begin() { bench.start("vehicle.pose", poses); }
    /** Jumps there; returns which pose follows. */
    double at(double seconds) {
        bench.task.seek(seconds);
        bench.updateAt(bench.task.nextTime()->microseconds);
        types::Pose pose;
        double found = -1;
        while (poses.port.readNew(pose)) found = pose.position.x;
        return found;
    }
    double span() { return bench.task.playback()->length_s; }
    double place() { return bench.task.playback()->at_s; }

    Bench bench;
    test::Reader<types::Pose> poses;
};

double setBack(int i) { return i < 20 ? 0 : -clock_step; }
double setForth(int i) { return i < 20 ? 0 : clock_step; }
double setBackAndForth(int i) { return i < 20 || i >= 40 ? 0 : -clock_step; }
double setForthAndBack(int i) { return i < 20 || i >= 40 ? 0 : clock_step; }

TEST(ReplayStepsTest, ASeekGoesWhereTheTimeWithoutStepsBackSays) {
    Recorded back(setBack);
    back.begin();
    EXPECT_NEAR(back.span(), 59, 1e-6);
    for (const double seconds : {0.0, 19.0, 20.0, 40.0, 59.0}) {
        EXPECT_EQ(back.at(seconds), seconds);
        EXPECT_NEAR(back.place(), seconds, 1e-6);
    }
    EXPECT_THROW(back.bench.task.seek(59.1), std::runtime_error);
}

TEST(ReplayStepsTest, AStepForwardIsAGap) {
    Recorded forth(setForth);
    forth.begin();
    EXPECT_NEAR(forth.span(), 59 + clock_step, 1e-6);
    EXPECT_EQ(forth.at(19), 19);
    for (const double seconds : {20.0, 300.0, 20 + clock_step}) EXPECT_EQ(forth.at(seconds), 20) << "behind the gap";
    EXPECT_NEAR(forth.place(), 20 + clock_step, 1e-6);
    EXPECT_EQ(forth.at(59 + clock_step), 59);
}

TEST(ReplayStepsTest, StepsBothWaysAddUp) {
    Recorded back(setBackAndForth);
    back.begin();
    EXPECT_NEAR(back.span(), 59 + clock_step, 1e-6);
    for (const double seconds : {10.0, 30.0, 39.0}) EXPECT_EQ(back.at(seconds), seconds);
    EXPECT_EQ(back.at(50 + clock_step), 50);
    Recorded forth(setForthAndBack);
    forth.begin();
    EXPECT_NEAR(forth.span(), 59 + clock_step, 1e-6);
    EXPECT_EQ(forth.at(10), 10);
    EXPECT_EQ(forth.at(30 + clock_step), 30);
    EXPECT_EQ(forth.at(50 + clock_step), 50);
}

TEST(ReplayStepsTest, AReplayStartsThereAndLoopsBackToThere) {
    Recorded late(setBack, {.file = {}, .from = 57, .loop = true});
    EXPECT_THAT(test::countRefusals(late.bench.task), IsEmpty());
    late.begin();
    EXPECT_NEAR(late.place(), 57, 1e-6);
    std::vector<double> places;
    for (int i = 0; i < 5; ++i) late.bench.updateAt(late.bench.task.nextTime()->microseconds);
    for (types::Pose pose; late.poses.port.readNew(pose);) places.push_back(pose.position.x);
    EXPECT_THAT(places, ElementsAre(57, 58, 59, 57, 58));
    Recorded beyond(setBack, {.file = {}, .from = 60});
    EXPECT_THAT(test::countRefusals(beyond.bench.task),
                ElementsAre("from: is 60 s; the log ends 59 s after its start"));
}

/** Two hours without a sample, after a step back: the notice names a start that is behind the gap. */
TEST(ReplayStepsTest, TheNoticeOfAGapNamesTheStartBehindIt) {
    const auto offset = [](int i) { return i < 20 ? 0.0 : i < 40 ? -7200.0 : -100.0; };
    Recorded gap(offset);
    gap.begin();
    const types::Notices notices = gap.bench.task.notices();
    ASSERT_FALSE(notices.empty());
    EXPECT_EQ(notices.front().kind, types::Notice::Kind::Warning);
    const std::string& notice = notices.front().text;
    const size_t at = notice.find("from: ");
    ASSERT_NE(at, notice.npos) << notice;
    const double from = std::stod(notice.substr(at + 6));
    EXPECT_NEAR(from, 40 + 7100, 1e-6);
    EXPECT_EQ(gap.at(from), 40);
    EXPECT_EQ(gap.at(100), 40) << "within the gap";
    EXPECT_EQ(gap.at(39), 39);
}

}  // namespace
}  // namespace insonify::replay
