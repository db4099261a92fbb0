// Options of a replay: start, pace, repetition, steps, and its clock.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "components/log/pocolog/Reader.hpp"
#include "components/log/pocolog/Writer.hpp"
#include "tests/deployer/Growing.hpp"
#include "tests/deployer/Wall.hpp"
#include "tests/support/Paths.hpp"
#include "types/samples/Sonar.hpp"

using namespace insonify::deployer;
using namespace insonify;
using testing::HasSubstr;
using testing::Not;

namespace {

/** A log of pings at 1.0, 1.1 and 1.2 s. */
struct ReplayPaceTest : testing::Test {
    void SetUp() override { ASSERT_EQ(folder_.run({"--pings", "3"}).code, 0); }
    std::vector<std::string> words(const std::vector<std::string>& more) const {
        std::vector<std::string> all = {"replay", "out/wall.0.log", "wall.yml", "--out", "again"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    void replay(const std::vector<std::string>& more) const {
        ASSERT_THAT(callInsonify(folder_, words(more)), succeeds());
    }
    /** Times of the replayed pings [ms]. */
    std::vector<int64_t> stamps() const {
        std::vector<int64_t> result;
        log::pocolog::Reader log(folder_ / "again/wall.0.log");
        log.forEach<insonify::types::Sonar>("noise.noisy",
                                            [&](const insonify::types::Sonar& ping, const log::SampleRef& at) {
                                                result.push_back(ping.time.microseconds / 1000);
                                                EXPECT_EQ(at.received, ping.time) << "the logger's clock is the log's";
                                            });
        return result;
    }
    double wallSeconds() const { return json::parse(readFile(folder_ / "summary.json"))["wall_s"]; }

    const WallFolder folder_;
};

}  // namespace

TEST_F(ReplayPaceTest, StartsAtTheGivenTimeAfterTheLogsFirstStamp) {
    replay({"--from", "0.1"});
    EXPECT_THAT(stamps(), testing::ElementsAre(1100, 1200));
}

TEST_F(ReplayPaceTest, ACutAndAReplayStartAtTheSameStamp) {
    ASSERT_EQ(callInsonify(folder_, {"log", "cut", "out/wall.0.log", "--from", "0.1", "--to", "part.0.log"}).code, 0);
    const auto part = log::openLog(folder_ / "part.0.log");
    EXPECT_EQ(part->samples().front().time.microseconds, 1'100'000);
}

/** Six pings 1 s apart; the clock is set by `step` s after the third. Seconds and dates lead to the same places. */
TEST_F(ReplayPaceTest, StartsBehindAStepOfTheClockBySecondsAndByDates) {
    using types::Time;
    types::Sonar ping;
    log::pocolog::Reader recorded(folder_ / "out/wall.0.log");
    recorded.forEach<types::Sonar>("noise.noisy", [&](const types::Sonar& one, const log::SampleRef&) { ping = one; });
    const Time first{1'800'000'000'000'000};
    const auto getStamp = [&](int i, int step) { return first + Time::fromSeconds(i + (i < 3 ? 0 : step)); };
    for (const int step : {-600, 600}) {
        {
            log::pocolog::Writer log(folder_ / "stepped.0.log");
            const size_t stream = log.addStream<types::Sonar>("noise.noisy");
            for (int i = 0; i < 6; ++i) ping.time = getStamp(i, step), log.write(stream, ping.time, ping);
            log.close();
        }
        const auto start = [&](const std::string& from) {
            EXPECT_THAT(
                callInsonify(folder_, {"replay", "stepped.0.log", "wall.yml", "--out", "again", "--from", from}),
                succeeds())
                << from << ", " << step;
            return Time{1000 * stamps().front()} - first;
        };
        const int behind = step > 0 ? 4 + step : 4;  // a step forward is a pause
        EXPECT_EQ(start("1"), Time::fromSeconds(1));
        EXPECT_EQ(start(std::to_string(behind)), Time::fromSeconds(behind));
        EXPECT_EQ(start(log::readable(getStamp(2, step))), Time::fromSeconds(2));
        if (step > 0) {
            EXPECT_EQ(start(log::readable(getStamp(4, step))), Time::fromSeconds(behind));
        }
        EXPECT_EQ(start(std::to_string(behind + 1)), Time::fromSeconds(behind + 1)) << "the last";
        EXPECT_THAT(
            callInsonify(folder_, {"replay", "stepped.0.log", "wall.yml", "--from", std::to_string(behind + 2)}),
            isRefused(HasSubstr("; the log ends ")));
    }
}

TEST_F(ReplayPaceTest, RefusesAStartAfterTheLogsEnd) {
    EXPECT_THAT(callInsonify(folder_, words({"--from", "3"})),
                isRefused(AllOf(HasSubstr("from: is 3 s; the log ends 0.2 s after its start"),
                                testing::Not(HasSubstr("nothing that would run it")))));
}

TEST_F(ReplayPaceTest, ASettingOfASonarWhosePingsTheLogReplacesIsANotice) {
    const std::string text = "notice: sonar: the log replaces what it sends; --rerender makes its pings again\n";
    EXPECT_THAT(callInsonify(folder_, words({"--set", "sonar.range=15"})).err, HasSubstr(text));
    EXPECT_THAT(callInsonify(folder_, words({"--set", "sonar.range=15", "--rerender"})).err,
                testing::Not(HasSubstr(text)));
    EXPECT_THAT(callInsonify(folder_, words({})).err, testing::Not(HasSubstr(text)));
}

TEST_F(ReplayPaceTest, InALoopTheLogRepeatsWhileTimeContinues) {
    replay({"--loop", "--duration", "0.65"});
    EXPECT_THAT(stamps(), testing::ElementsAre(1000, 1100, 1200, 1300, 1400, 1500, 1600));
    EXPECT_EQ(python(folder_,
                     "import subprocess, numpy\n"
                     "for log, stream in (('out', 'noise.noisy'), ('again', 'noise.noisy')):\n"
                     "    subprocess.run(['" +
                         test::program("insonify") +
                         "', 'log', 'export', log + '/wall.0.log',"
                         " '--stream', stream, '--to', log + '.npz'], stdout=subprocess.DEVNULL, check=True)\n"
                         "a, b = numpy.load('out.npz')['bins'], numpy.load('again.npz')['bins']\n"
                         "print((b == a[[0, 1, 2, 0, 1, 2, 0]]).all())")
                  .out,
              "True\n");
}

TEST_F(ReplayPaceTest, PaceLimitsTheSpeedAndChangesNothingElse) {
    replay({});
    const std::string fast = readFile(folder_ / "again/wall.0.log");
    replay({"--pace", "0.25", "--summary", "summary.json"});
    EXPECT_GE(wallSeconds(), 0.8) << "0.2 s at a quarter of the pace";
    EXPECT_EQ(readFile(folder_ / "again/wall.0.log"), fast);
}

TEST_F(ReplayPaceTest, StepWaitsForALineAfterEachInstant) {
    ASSERT_EQ(mkfifo((folder_ / "lines").c_str(), 0600), 0);
    const Process process(
        {"/bin/sh", "-c",
         "exec " + test::program("insonify") + " replay out/wall.0.log wall.yml --out again --step < lines"},
        folder_.path());
    std::ofstream lines(folder_ / "lines");
    ASSERT_TRUE(says(folder_, "0.000000 s\n"));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_THAT(readFile(folder_ / "stderr.txt"), Not(HasSubstr("0.100000 s\n")));
    lines << std::endl;
    ASSERT_TRUE(says(folder_, "0.100000 s\n"));
    EXPECT_THAT(readFile(folder_ / "stderr.txt"), Not(HasSubstr("0.200000 s\n")));
    lines << "\n\n" << std::flush;
    lines.close();
    EXPECT_EQ(process.wait().code, 0);
    EXPECT_EQ(stamps().size(), 3u);
}

TEST_F(ReplayPaceTest, StepSeeksToATimeInTheLog) {
    const Outcome outcome = Process({"/bin/sh", "-c",
                                     "printf '\\nseek x\\nseek 0\\n' | " + test::program("insonify") +
                                         " replay out/wall.0.log wall.yml --out again --step"},
                                    folder_.path())
                                .wait();
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(stamps(), testing::ElementsAre(1000, 1100, 1200, 1300, 1400));
    EXPECT_THAT(outcome.err, HasSubstr("insonify: seek[0]"));
    EXPECT_THAT(outcome.err, testing::ContainsRegex("0.100000 s\ninsonify: seek[^\n]*\n0.000000 s\n"))
        << "the time in the log";
}

TEST_F(ReplayPaceTest, ARealtimeDeploymentIsReplayedOnTheLogsTime) {
    writeFile(folder_ / "wall.yml", replaced(wall_deployment, "schedule: lockstep", "schedule: realtime"));
    replay({});
    EXPECT_THAT(stamps(), testing::ElementsAre(1000, 1100, 1200));
}

TEST_F(ReplayPaceTest, AReplayTaskInRealtimeSetsTheTimeOfAllTasks) {
    writeFile(folder_ / "realtime.yml", R"(schedule: realtime
tasks:
  replay: {type: replay::ReplayTask, properties: {file: out/wall.0.log, loop: true}}
  log: {type: logger::LoggerTask, properties: {file: again.0.log}}
connections:
  - {from: replay.vehicle.pose, to: log.pose, policy: {type: buffer, size: 64}}
)");
    const Process process(insonifyWords({"run", "realtime.yml", "--out", "again"}), folder_.path());
    EXPECT_TRUE(insonify::test::becomesTrue(
        [&] { return flushedSamples(folder_ / "again/again.0.log", "vehicle.pose") >= 4; }));
    process.signal(SIGINT);
    ASSERT_THAT(process.wait(), succeeds());
    log::pocolog::Reader log(folder_ / "again/again.0.log");
    for (const log::SampleRef& at : log.samples()) {
        EXPECT_GE(at.received, at.time);
        EXPECT_LT((at.received - at.time).seconds(), 3600) << "not of this year";
    }
}
