// Every file in deploy/ runs. Files that wait for other programs have their own tests: ROS 2 in
// tests/dds/Ros2RunTest.cpp, drivers of devices in tests/device and tests/deployer/PingDriverTest.cpp, MAVLink and
// Gazebo in tests/mavlink/MavlinkRunTest.cpp and tests/gazebo/GazeboRunTest.cpp.
#include <gmock/gmock.h>

#include "tests/deployer/Command.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;

namespace {

const fs::path deploy = fs::path(insonify::test::source_dir) / "deploy";

std::vector<std::string> deployments() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(deploy))
        if (const std::string name = entry.path().stem(); entry.path().extension() == ".yml" && name != "replay" &&
                                                          !name.starts_with("ros2_") && !name.starts_with("hil_") &&
                                                          !name.starts_with("mavlink_") && !name.starts_with("gazebo_"))
            names.push_back(name);
    std::sort(names.begin(), names.end());
    return names;
}

std::vector<std::string> getRun(const std::string& deployment, std::vector<std::string> more) {
    std::vector<std::string> words = {"run", deploy / (deployment + ".yml"), "--out", deployment};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

struct DeploymentFilesTest : testing::TestWithParam<std::string> {
    void SetUp() override {
        const std::string lacks = callInsonify(folder, {"libraries", deploy / (GetParam() + ".yml")}).out;
        if (!lacks.empty())
            GTEST_SKIP() << "NOT TESTED: this system has no packages for the component library " << lacks;
    }
    const TestFolder folder;
};

}  // namespace

TEST_P(DeploymentFilesTest, RunsForTwoPings) {
    const bool lockstep = readFile(deploy / (GetParam() + ".yml")).find("schedule: realtime") == std::string::npos;
    std::vector<std::string> more = {"--pings", "2", "--summary", "summary.json"};
    if (!lockstep)  // a slow machine must not look like a missing vehicle
        more.insert(more.end(), {"--set", "scene.pose_timeout=60"});
    ASSERT_THAT(callInsonify(folder, getRun(GetParam(), more)), succeeds());
    const json summary = json::parse(readFile(folder / "summary.json"));
    EXPECT_GE(summary["pings"], 2);
    for (const auto& [connection, lost] : summary["losses"].items())  // in realtime the newest sample is used
        EXPECT_TRUE(lost == 0 || !lockstep) << connection << ": " << lost;
}

TEST_P(DeploymentFilesTest, IsValid) {
    EXPECT_EQ(callInsonify(folder, {"check", deploy / (GetParam() + ".yml")}).code, 0);
}

INSTANTIATE_TEST_SUITE_P(All, DeploymentFilesTest, testing::ValuesIn(deployments()),
                         [](const auto& tested) { return tested.param; });

TEST(DeliveredFilesTest, NamedFilesExist) {
    EXPECT_THAT(deployments(),
                testing::IsSupersetOf({"gemini_720i", "harbour_fls", "harbour_msis", "harbour_msis_sector",
                                       "harbour_profiler", "harbour_sidescan", "harbour_altimeter", "harbour_sonar3d",
                                       "minimal", "rock_dropin", "tank_mosaic", "two_vehicles"}));
}

TEST(DeliveredFilesTest, ReplayShowsTheLatestHarbourRun) {
    const TestFolder folder;
    fs::copy(deploy, folder / "deploy", fs::copy_options::recursive);
    ASSERT_EQ(callInsonify(folder, {"run", "deploy/harbour_fls.yml", "--pings", "2"}).code, 0);
    ASSERT_THAT(callInsonify(folder, {"run", "deploy/replay.yml", "--out", "again", "--summary", "summary.json"}),
                succeeds());
    EXPECT_FALSE(fs::is_empty(folder / "again"));
}
