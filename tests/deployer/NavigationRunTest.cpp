// The bag of deploy/navigation.yml, read as the SLAM package reads it for which it is written; and its sensors again
// from a log of poses.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/deployer/Command.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"

using namespace insonify;
using namespace insonify::deployer;

namespace {

const std::string navigation = test::sourceFile("deploy/navigation.yml");

struct NavigationRunTest : testing::Test {
    /** Runs it with a small, fast sonar. */
    void run(const std::string& out, std::vector<std::string> more = {}) {
        std::vector<std::string> words = {"run",   navigation,
                                          "--out", out,
                                          "--set", "sonar.beam_count=32",
                                          "--set", "sonar.bin_count=100",
                                          "--set", "sonar.quality={rows: 16, columns_per_beam: 1}"};
        words.insert(words.end(), more.begin(), more.end());
        ASSERT_THAT(callInsonify(folder_, words), succeeds());
    }
    /** Returns the reader's output for a bag. */
    json read(const std::string& out) const {
        const std::string answer = pythonSays(
            test::sourceFile("tests/deployer/read_navigation.py ") + (folder_ / out).string(), folder_ / "answer");
        const json reported = json::parse(answer, nullptr, false);
        EXPECT_FALSE(reported.is_discarded()) << answer;
        return reported;
    }
    std::string exported(const std::string& log, const std::string& stream) const {
        EXPECT_THAT(callInsonify(folder_, {"log", "export", log, "--stream", stream, "--to", "of_" + stream + ".csv"}),
                    succeeds());
        return readFile(folder_ / ("of_" + stream + ".csv"));
    }
    const TestFolder folder_;
};

/** Removes the errors from the inputs of dead reckoning. */
std::vector<std::string> withoutErrors() {
    std::vector<std::string> words;
    for (const char* key : {"dvl.errors.velocity_noise", "dvl.errors.scale_error", "dvl.errors.velocity_bias",
                            "imu.attitude.tilt_deviation_deg", "imu.attitude.heading_deviation_deg",
                            "pressure.errors.noise", "pressure.errors.drift_deviation"})
        words.insert(words.end(), {"--set", std::string(key) + "=0"});
    return words;
}

}  // namespace

TEST_F(NavigationRunTest, ASlamPackageReadsEveryMessageAndReckonsThePath) {
    if (!pythonHas("rosbags, numpy"))
        GTEST_SKIP() << "SKIPPED: the Python package rosbags is missing; scripts/setup installs it";
    run("bag");
    const json found = read("bag");
    EXPECT_EQ(found["types"], json({{"/oculus/sonar_image", "marine_acoustic_msgs/msg/ProjectedSonarImage"},
                                    {"/dvl/data", "marine_acoustic_msgs/msg/Dvl"},
                                    {"/mavros/imu/data", "sensor_msgs/msg/Imu"},
                                    {"/pressure", "sensor_msgs/msg/FluidPressure"},
                                    {"/truth/odometry", "nav_msgs/msg/Odometry"}}));
    EXPECT_TRUE(found["dropped"].empty()) << found["dropped"];
    EXPECT_EQ(found["counts"]["/oculus/sonar_image"], 429);
    EXPECT_EQ(found["counts"]["/dvl/data"], 685) << "eight a second for 85.6 s";
    EXPECT_EQ(found["counts"]["/mavros/imu/data"], 8559)
        << "a hundred a second, except for the first pose and the last";
    EXPECT_EQ(found["shape"], json({100, 32}));
    EXPECT_EQ(found["loudest"], 255);
    EXPECT_GT(found["to_port"], 0.55) << "where the quay is, and bearings are positive";
    EXPECT_NEAR(found["length"], 85.9, 0.1);
    EXPECT_LT(found["worst"], 0.6) << "a degree of heading, 0.7 % of the path";
    EXPECT_GT(found["worst"], 0.1) << "that would be no error";
    EXPECT_LT(found["depth_error"], 0.05) << "of a reader with another density";
    std::cout << found << '\n';
}

TEST_F(NavigationRunTest, WithoutErrorsThePathCloses) {
    if (!pythonHas("rosbags, numpy"))
        GTEST_SKIP() << "SKIPPED: the Python package rosbags is missing; scripts/setup installs it";
    run("bag", withoutErrors());
    const json found = read("bag");
    EXPECT_LT(found["worst"], 0.15) << "what eight velocities a second, taken as level, leave of 86 m";
    EXPECT_LT(found["end_error"], 0.05);
    EXPECT_LT(found["depth_error"], 0.03);
    std::cout << found << '\n';
}

TEST_F(NavigationRunTest, ReadingsFollowFromTheSeed) {
    run("a", {"--duration", "3", "--set", "log.file=a.0.log"});
    run("b", {"--duration", "3", "--set", "log.file=a.0.log"});
    run("c", {"--duration", "3", "--set", "log.file=a.0.log", "--seed", "4"});
    for (const char* stream : {"dvl.dvl", "imu.imu", "pressure.pressure"}) {
        const std::string readings = exported("a/a.0.log", stream);
        EXPECT_GT(readings.size(), 400u);
        EXPECT_EQ(exported("b/a.0.log", stream), readings);
        EXPECT_NE(exported("c/a.0.log", stream), readings);
    }
}

TEST_F(NavigationRunTest, ShardsHaveEachReadingOfTheWholeRunOnce) {
    const std::vector<std::string> log = {"--pings", "6", "--set", "log.file=x.0.log"};
    run("whole", log);
    for (const char* shard : {"0/3", "1/3", "2/3"}) {
        std::vector<std::string> words = log;
        words.insert(words.end(), {"--shard", shard});
        run("parts", words);
    }
    const auto rows = [](const std::string& csv) { return csv.substr(csv.find('\n') + 1); };
    for (const char* stream : {"dvl.dvl", "imu.imu", "pressure.pressure"}) {
        std::string joined;
        for (const char* part : {"0", "1", "2"})
            joined += rows(exported(std::string("parts/shard_") + part + "_of_3/x.0.log", stream));
        EXPECT_EQ(joined, rows(exported("whole/x.0.log", stream))) << stream;
    }
}

TEST_F(NavigationRunTest, ALogOfPosesGivesTheSameReadingsWhenItIsReplayed) {
    writeFile(folder_ / "sensors.yml", R"(
tasks:
  motion:
    type: pose::TrajectoryTask
    activity: {period: 0.01}
    properties: {smooth: true, waypoints: [{time: 0, position: [0, 0, -5]}, {time: 2, position: [2, 1, -6], yaw_deg: 90}]}
  imu:
    type: nav::ImuTask
    properties: {gyroscope: {noise_density: 1.0e-3, bias_deviation: 1.0e-3}, attitude: {heading_deviation_deg: 1}}
  dvl: {type: nav::DvlTask, properties: {bottom_height: -20, errors: {velocity_noise: 0.01, dropout: 0.1}}}
  pressure: {type: nav::PressureTask, properties: {errors: {noise: 20, drift_deviation: 100}}}
  log: {type: logger::LoggerTask, properties: {file: x.0.log}}
connections:
  - {from: motion.pose, to: imu.pose}
  - {from: motion.pose, to: dvl.pose}
  - {from: motion.pose, to: pressure.pose}
  - {from: motion.pose, to: log.pose, policy: {type: buffer, size: 256}}
  - {from: imu.imu, to: log.imu, policy: {type: buffer, size: 256}}
  - {from: dvl.dvl, to: log.dvl, policy: {type: buffer, size: 256}}
  - {from: pressure.pressure, to: log.pressure, policy: {type: buffer, size: 256}}
)");
    const auto call = [&](std::vector<std::string> words) { EXPECT_THAT(callInsonify(folder_, words), succeeds()); };
    call({"run", "sensors.yml", "--out", "a"});
    call({"log", "cut", "a/x.0.log", "--to", "poses.0.log", "--stream", "motion.pose"});
    call({"replay", "poses.0.log", "sensors.yml", "--out", "b"});
    for (const char* stream : {"dvl.dvl", "imu.imu", "pressure.pressure"}) {
        const std::string readings = exported("a/x.0.log", stream);
        EXPECT_GT(std::ranges::count(readings, '\n'), 195) << stream;
        EXPECT_EQ(exported("b/x.0.log", stream), readings) << stream;
    }
}
