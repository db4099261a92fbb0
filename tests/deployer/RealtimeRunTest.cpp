// schedule: realtime, in runs of the command.
#include <gmock/gmock.h>

#include <csignal>

#include "tests/deployer/Growing.hpp"
#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::Contains;
using testing::HasSubstr;

namespace {

/** Without a pose for 0.2 s there is an error until the next pose; poses have this period [s]. */
std::string withPosesEach(const std::string& seconds) {
    const std::string text = replaced(realtimeWall(), "period: 0.1", "period: " + seconds);
    return replaced(text, "pose_timeout: 60", "pose_timeout: 0.2");
}

size_t countIn(const std::string& text, const std::string& what) {
    size_t count = 0;
    for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
    return count;
}

}  // namespace

TEST(RealtimeRunTest, TheSummaryReportsMetAndMissedTimes) {
    const WallFolder folder(
        replaced(realtimeWall(), "{trigger: [snapshot]}", "{trigger: [snapshot], deadline: 0.001}"));
    const Outcome outcome = folder.run({"--pings", "4", "--summary", "summary.json", "--verbose"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json summary = json::parse(readFile(folder / "summary.json"));
    const json& vehicle = summary["tasks"]["vehicle"];
    EXPECT_EQ(vehicle["jitter"]["count"], vehicle["cycles"]);
    EXPECT_GE(vehicle["overruns"], 0);
    const json& sonar = summary["tasks"]["sonar"];
    // No ping is written before 2 x 20 m / 1500 m/s, so that all miss a deadline of 1 ms.
    EXPECT_GE(sonar["latency"]["median_ms"], 0.99 * 2 * 20 / 1500 * 1e3);
    EXPECT_GE(sonar["latency"]["max_ms"], sonar["latency"]["p99_ms"]);
    EXPECT_GE(sonar["latency"]["count"], 4);
    EXPECT_EQ(sonar["late"], sonar["latency"]["count"]);
    EXPECT_EQ(sonar["errors"], 0);
    EXPECT_EQ(sonar["hangs"], 0);
    EXPECT_TRUE(summary["warnings"].is_array());
    EXPECT_THAT(outcome.out, HasSubstr("jitter median, p99, max ms"));
    EXPECT_THAT(outcome.out, HasSubstr("latency median, p99, max ms"));
}

TEST(RealtimeRunTest, ALockstepSummaryHasNoTimesOfRealtime) {
    const WallFolder folder;
    ASSERT_THAT(folder.run({"--pings", "1", "--summary", "summary.json"}), prints(testing::Not(HasSubstr("jitter"))));
    EXPECT_FALSE(json::parse(readFile(folder / "summary.json"))["tasks"]["sonar"].contains("overruns"));
}

TEST(RealtimeRunTest, StalePosesAreReportedAndPingsContinueWithNewPoses) {
    const WallFolder folder(withPosesEach("1"));
    const Process process(insonifyWords({"run", "wall.yml", "--out", "out", "--summary", "summary.json"}),
                          folder.path());
    EXPECT_TRUE(insonify::test::becomesTrue([&] {
        return countIn(readFile(folder / "stderr.txt"), "scene: has recovered") >= 2 &&
               flushedSamples(folder / "out/wall.0.log", "sonar.ping") >= 3;
    }));
    process.signal(SIGINT);
    const Outcome outcome = process.wait();
    const json summary = json::parse(readFile(folder / "summary.json"));
    EXPECT_GE(summary["tasks"]["scene"]["errors"], 2);
    EXPECT_GE(summary["pings"], 3);
    EXPECT_THAT(summary["warnings"].get<std::vector<std::string>>(),
                Contains("scene: RunTimeError: scene.pose: no pose in the last 0.2 s (pose_timeout)"));
    EXPECT_THAT(outcome.err, HasSubstr("warning: scene: has recovered"));
}

TEST(RealtimeRunTest, PosesThatEndBeforeTheRunAreReportedAndNotAFailure) {
    const WallFolder folder(withPosesEach("1000"));
    const Process process(insonifyWords({"run", "wall.yml", "--out", "out"}), folder.path());
    EXPECT_TRUE(says(folder, "warning: scene: RunTimeError"));
    process.signal(SIGINT);
    const Outcome outcome = process.wait();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("warning: scene: RunTimeError: scene.pose: no pose in the last 0.2 s"));
}
