#include <gmock/gmock.h>

#include <csignal>

#include "tests/deployer/Growing.hpp"
#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

json logInfo(const TestFolder& folder, const std::string& log) {
    return json::parse(callInsonify(folder, {"log", "info", log, "--json"}).out);
}

/** Samples of the first stream of a log. */
size_t samplesIn(const TestFolder& folder, const std::string& log) {
    return logInfo(folder, log)["streams"][0]["count"];
}

}  // namespace

TEST(RunCommandTest, TheSummaryHasPingsTimesLossesAndOmissions) {
    const WallFolder folder;
    ASSERT_THAT(folder.run({"--pings", "3", "--summary", "summary.json"}), prints(HasSubstr("3 pings in ")));
    const json summary = json::parse(readFile(folder / "summary.json"));
    EXPECT_EQ(summary["pings"], 3);
    EXPECT_GT(summary["wall_s"], 0);
    const json& sonar = summary["tasks"]["sonar"];
    EXPECT_EQ(sonar["state"], "Stopped");
    EXPECT_EQ(sonar["cycles"], 3);
    for (const char* time : {"median_ms", "p99_ms", "max_ms"}) EXPECT_GT(sonar[time], 0) << time;
    for (const char* stage : {"cull", "draw", "read", "deposit", "beams"})
        EXPECT_TRUE(sonar["stages"][stage].contains("p99_ms")) << stage;
    EXPECT_EQ(summary["losses"]["noise.noisy>log.noisy"], 0);
    EXPECT_EQ(summary["passed_over"]["noise.noisy>log.noisy"], 0);
    EXPECT_NE(summary["omitted"][0]["reason"], "");
}

TEST(RunCommandTest, StatsPrintsWhatTheStagesOfASonarCount) {
    const WallFolder folder;
    const Outcome plain = folder.run({"--pings", "3"});
    const Outcome counted = folder.run({"--pings", "3", "--stats", "--summary", "summary.json"});
    EXPECT_THAT(counted, prints(HasSubstr("sonar, 3 pings\n")));
    EXPECT_THAT(counted.out, HasSubstr("rays                   1024.0"));  // 32 rows, 2 columns in each of 16 beams
    EXPECT_THAT(plain, prints(testing::Not(HasSubstr("rays"))));
    EXPECT_THAT(plain.out, testing::Not(HasSubstr("stage")));
    const json counts = json::parse(readFile(folder / "summary.json"))["tasks"]["sonar"]["counts"];
    EXPECT_EQ(counts["pings"], 3);
    EXPECT_GE(counts["undivided_share"], 0);
    EXPECT_LT(counts["undivided_share"], 1);
    EXPECT_THAT(counted.out, HasSubstr("not divided among threads: "));
    EXPECT_EQ(counts["rays"]["total"], 3 * 1024);
    EXPECT_EQ(counts["rays"]["per_ping"], 1024);
    EXPECT_EQ(counts["rays"]["stage"], "draw");
    EXPECT_GT(counts["rays"]["per_second"], 0);
    EXPECT_EQ(counts["bins"]["per_ping"], 16 * 50);
    EXPECT_THAT(folder.run({"--quiet", "--stats"}), isRefused(HasSubstr("--stats")));
}

TEST(RunCommandTest, QuietPrintsNothing) {
    const WallFolder folder;
    const Outcome outcome = folder.run({"--pings", "2", "--quiet"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.out + outcome.err, "");
}

TEST(RunCommandTest, WithoutAnOutputFolderMakesANewFolderLinkedByLatest) {
    const WallFolder folder;
    ASSERT_EQ(callInsonify(folder, {"run", "wall.yml", "--pings", "1"}).code, 0);
    ASSERT_EQ(callInsonify(folder, {"run", "wall.yml", "--pings", "2"}).code, 0);
    EXPECT_TRUE(fs::is_symlink(folder / "out/latest"));
    EXPECT_EQ(samplesIn(folder, "out/latest/wall.0.log"), 2u);
    EXPECT_TRUE(fs::read_symlink(folder / "out/latest").string().starts_with("wall-"));
}

TEST(RunCommandTest, DurationIsInSecondsOfSimulatedTime) {
    const WallFolder folder;
    ASSERT_EQ(folder.run({"--duration", "1.05"}).code, 0);
    const size_t samples = samplesIn(folder, "out/wall.0.log");
    EXPECT_GE(samples, 10u);
    EXPECT_LE(samples, 12u);
}

TEST(RunCommandTest, AFixedPoseInLockstepIsOnePing) {
    const WallFolder folder;
    ASSERT_EQ(folder.run({}).code, 0);
    EXPECT_EQ(samplesIn(folder, "out/wall.0.log"), 1u);
}

TEST(RunCommandTest, SetOverridesTheFile) {
    const WallFolder folder;
    ASSERT_EQ(folder.run({"--set", "sonar.bin_count=7", "--set", "sonar.quality.rows=16", "--pings", "1"}).code, 0);
    ASSERT_EQ(
        callInsonify(folder, {"log", "export", "out/wall.0.log", "--stream", "sonar.ping", "--to", "ping.npz"}).code,
        0);
    EXPECT_EQ(python(folder, "import numpy; print(numpy.load('ping.npz')['bins'].shape)").out, "(1, 16, 7)\n");
}

TEST(RunCommandTest, OperationsAreCalledByName) {
    const WallFolder folder;
    EXPECT_THAT(folder.run({"--pings", "1", "--call", "sonar.setRnge=8"}),
                isRefused(HasSubstr("sonar has no operation setRnge; did you mean setRange?")))
        << "no such operation";
    EXPECT_THAT(folder.run({"--call", "snar.start"}).err, HasSubstr("there is no task snar; did you mean sonar?"));
    const Outcome refused = folder.run({"--call", "sonar.configure", "--call", "sonar.recover"});
    EXPECT_EQ(refused.code, 1);
    EXPECT_THAT(refused.err, HasSubstr("insonify: --call sonar.recover: cannot recover: sonar is Stopped"));
    EXPECT_THAT(folder.run({"--call", "sonar.setRange=-1"}), isRefused(HasSubstr("--call: is sonar.setRange=-1: ")));
    EXPECT_THAT(folder.run({"--call", "sonar.setRange"}), isRefused(HasSubstr("--call: is sonar.setRange: ")));
    ASSERT_THAT(folder.run({"--pings", "1", "--call", "sonar.setRange=12", "--call", "noise.clamped"}),
                prints(HasSubstr("noise.clamped: 0\n")));
}

TEST(RunCommandTest, LockstepRunTwiceGivesTheSameLogBitForBit) {
    const WallFolder folder;
    for (const char* out : {"first", "second"})
        ASSERT_EQ(callInsonify(folder, {"run", "wall.yml", "--pings", "5", "--seed", "3", "--out", out}).code, 0);
    const std::string log = readFile(folder / "first/wall.0.log");
    EXPECT_GT(log.size(), 30'000u);
    EXPECT_TRUE(log == readFile(folder / "second/wall.0.log"));
}

namespace {

/** Two sonars, and two sensors of each kind, on one vehicle; none has a `seed` property set. */
std::string twins() {
    std::string text = replaced(wall_deployment, "seed: 7, ", "");
    const std::string tasks = R"(  twin: {type: noise::NoiseTask, properties: {speckle: {law: rayleigh}}}
  imu_a: {type: nav::ImuTask, properties: {gyroscope: {noise_density: 1e-4}}}
  imu_b: {type: nav::ImuTask, properties: {gyroscope: {noise_density: 1e-4}}}
  dvl_a: {type: nav::DvlTask, properties: {bottom_height: -9, errors: {velocity_noise: 0.01}}}
  dvl_b: {type: nav::DvlTask, properties: {bottom_height: -9, errors: {velocity_noise: 0.01}}}
  gauge_a: {type: nav::PressureTask, properties: {errors: {noise: 10}}}
  gauge_b: {type: nav::PressureTask, properties: {errors: {noise: 10}}}
connections:
  - {from: sonar.ping, to: twin.clean}
  - {from: twin.noisy, to: log.twin, policy: {type: buffer, size: 64}}
)";
    std::string connections;
    for (const std::string unit :
         {"imu_a.imu", "imu_b.imu", "dvl_a.dvl", "dvl_b.dvl", "gauge_a.depth_samples", "gauge_b.depth_samples"}) {
        const std::string task = unit.substr(0, unit.find('.'));
        connections += "  - {from: vehicle.pose, to: " + task + ".pose, policy: {type: buffer, size: 64}}\n" +
                       "  - {from: " + unit + ", to: log." + task + ", policy: {type: buffer, size: 64}}\n";
    }
    return replaced(text, "connections:\n", tasks + connections);
}

}  // namespace

TEST(RunCommandTest, TasksOfOneKindHaveDifferentRepeatableErrors) {
    const WallFolder folder(twins());
    for (const auto& [out, seed] :
         {std::pair("first", "0"), std::pair("second", "0"), std::pair("other", "1"), std::pair("third", "2")})
        ASSERT_EQ(callInsonify(folder, {"run", "wall.yml", "--pings", "5", "--out", out, "--seed", seed}).code, 0);
    const auto readings = [&](const std::string& out, const std::string& stream) {
        const std::string log = out + "/wall.0.log";
        EXPECT_EQ(callInsonify(folder, {"log", "export", log, "--stream", stream, "--to", "x.csv"}).code, 0) << stream;
        return readFile(folder / "x.csv");
    };
    for (const auto& [one, twin] :
         {std::pair("noise.noisy", "twin.noisy"), std::pair("imu_a.imu", "imu_b.imu"),
          std::pair("dvl_a.dvl", "dvl_b.dvl"), std::pair("gauge_a.depth_samples", "gauge_b.depth_samples")}) {
        EXPECT_NE(readings("first", one), readings("first", twin)) << one;
        EXPECT_NE(readings("first", one), readings("third", one)) << one;
        EXPECT_EQ(readings("first", one), readings("other", one)) << one << ": the deployment's seed is 1";
    }
    EXPECT_TRUE(readFile(folder / "first/wall.0.log") == readFile(folder / "second/wall.0.log"));
}

TEST(RunCommandTest, AnotherSeedGivesOtherNoise) {
    const WallFolder folder;
    for (const char* seed : {"3", "4"})
        ASSERT_EQ(callInsonify(folder, {"run", "wall.yml", "--pings", "1", "--seed", seed, "--out", seed}).code, 0);
    for (const char* seed : {"3", "4"})
        for (const char* stream : {"sonar.ping", "noise.noisy"})
            ASSERT_EQ(callInsonify(folder, {"log", "export", std::string(seed) + "/wall.0.log", "--stream", stream,
                                            "--to", std::string(stream) + seed + ".npz"})
                          .code,
                      0);
    const Outcome reported = python(folder, R"(
import numpy
same = lambda stream: (numpy.load(f'{stream}3.npz')['bins'] == numpy.load(f'{stream}4.npz')['bins']).all()
print(same('sonar.ping'), same('noise.noisy')))");
    EXPECT_EQ(reported.out, "True False\n") << reported.err;
}

class SignalTest : public testing::TestWithParam<int> {};

TEST_P(SignalTest, StopsCleanlyAndClosesTheLog) {
    const WallFolder folder(realtimeWall());
    const Process process(insonifyWords({"run", "wall.yml", "--out", "out"}), folder.path());
    EXPECT_TRUE(
        insonify::test::becomesTrue([&] { return flushedSamples(folder / "out/wall.0.log", "sonar.ping") >= 2; }));
    process.signal(GetParam());
    EXPECT_THAT(process.wait(), prints(HasSubstr(" pings in ")));
    const json info = logInfo(folder, "out/wall.0.log");
    EXPECT_TRUE(info["complete"]);
    EXPECT_GT(info["streams"][0]["count"], 1);
}

INSTANTIATE_TEST_SUITE_P(Both, SignalTest, testing::Values(SIGINT, SIGTERM),
                         [](const auto& tested) { return tested.param == SIGINT ? "Interrupt" : "Terminate"; });

TEST(RunCommandTest, ARealtimeRunEndsAfterItsPings) {
    const WallFolder folder(realtimeWall());
    ASSERT_EQ(folder.run({"--pings", "3"}).code, 0);
    EXPECT_GE(samplesIn(folder, "out/wall.0.log"), 3u);
}

/** A device whose driver is silent must not hide the pings of another. */
TEST(RunCommandTest, SonarsThatPingUnequallyAreCountedByThemselves) {
    const std::string second = replaced(
        replaced(wall_deployment, "  noise:\n",
                 "  slow:\n    type: sonar::SonarTask\n    activity: {period: 0.5}\n    properties: {beam_count: 4}\n"
                 "  noise:\n"),
        "  - {from: scene.snapshot, to: sonar.snapshot}\n",
        "  - {from: scene.snapshot, to: sonar.snapshot}\n  - {from: scene.snapshot, to: slow.snapshot}\n");
    const WallFolder folder(second);
    const Outcome run =
        callInsonify(folder, {"run", "wall.yml", "--duration", "2", "--out", "out", "--summary", "summary.json"});
    EXPECT_THAT(run.out, testing::ContainsRegex("20 pings in .* per second, slow.ping 4, sonar.ping 20\n"));
    const json summary = json::parse(readFile(folder / "summary.json"));
    EXPECT_EQ(summary["pings"], 20);
    EXPECT_EQ(summary["pings_by_port"], json({{"slow.ping", 4}, {"sonar.ping", 20}}));
}
