// deploy/mavlink_poses.yml, and errors of other deployments as a user sees them.
#include <gmock/gmock.h>
#include <signal.h>

#include <regex>

#include "tests/deployer/Command.hpp"
#include "tests/mavlink/Vehicle.hpp"
#include "tests/support/Needs.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify;
using namespace insonify::deployer;
using test::becomesTrue;
using testing::HasSubstr;

namespace {

const std::string deployment = test::sourceFile("deploy/mavlink_poses.yml");

struct MavlinkRunTest : testing::Test {
    std::vector<std::string> words(std::vector<std::string> more) const {
        std::vector<std::string> all = {"run",   deployment,        "--out", "out",
                                        "--set", "vehicles.port=0", "--set", "scene.pose_timeout=60"};
        all.insert(all.end(), more.begin(), more.end());
        return insonifyWords(all);
    }
    /** Waits until the run listens, and returns its port. */
    int port() const {
        std::smatch found;
        std::string text;
        const bool reported = becomesTrue([&] {
            text = readFile(folder / "stderr.txt");
            return std::regex_search(text, found, std::regex(R"(listens on UDP [^ ]*:(\d+))"));
        });
        return reported ? std::stoi(found[1]) : 0;
    }
    bool says(const std::string& text) const {
        return becomesTrue([&] { return readFile(folder / "stderr.txt").find(text) != std::string::npos; });
    }
    TestFolder folder;
};

}  // namespace

TEST_F(MavlinkRunTest, RequestsPosesOfTwoVehiclesForPings) {
    INSONIFY_NEEDS("sdf");
    if (!mavlink::Vehicle::available()) GTEST_SKIP() << "PyPI's pymavlink is not in " << python();
    const Process run(words({"--pings", "20", "--summary", "summary.json"}), folder.path());
    const auto listening = static_cast<uint16_t>(port());
    if (listening == 0) run.signal(SIGKILL);
    ASSERT_NE(listening, 0);
    const mavlink::Vehicle red(listening, "heartbeat 1"), blue(listening, "heartbeat 2 12");
    const bool pings = becomesTrue([&] { return fs::exists(folder / "out/fan_000000.png"); });
    if (!pings) run.signal(SIGKILL);
    ASSERT_THAT(run.wait(), succeeds());
    const json summary = json::parse(readFile(folder / "summary.json"));
    EXPECT_GE(summary["pings"], 20);
    EXPECT_FALSE(fs::is_empty(folder / "out"));
}

TEST_F(MavlinkRunTest, WaitsWithoutAVehicleAndReportsIt) {
    INSONIFY_NEEDS("sdf");
    const Process run(words({"--set", "scene.pose_timeout=0.2"}), folder.path());
    EXPECT_TRUE(says("warning: scene: scene.pose: waits for the first pose")) << readFile(folder / "stderr.txt");
    run.signal(SIGINT);
    EXPECT_EQ(run.wait().code, 0);
}

TEST_F(MavlinkRunTest, PingsStopAndResumeWithAVehicle) {
    INSONIFY_NEEDS("sdf");
    if (!mavlink::Vehicle::available()) GTEST_SKIP() << "PyPI's pymavlink is not in " << python();
    const Process run(words({"--set", "scene.pose_timeout=2"}), folder.path());
    const auto listening = static_cast<uint16_t>(port());
    const auto fly = [&] {
        return std::pair{std::make_unique<mavlink::Vehicle>(listening, "poses2 1"),
                         std::make_unique<mavlink::Vehicle>(listening, "poses2 2 12")};
    };
    auto vehicles = fly();
    EXPECT_TRUE(becomesTrue([&] { return fs::exists(folder / "out/fan_000000.png"); }));
    vehicles = {};
    EXPECT_TRUE(says("no pose in the last 2 s (pose_timeout)"));
    vehicles = fly();
    const auto pictures = [&] {
        return std::distance(fs::directory_iterator(folder / "out"), fs::directory_iterator{});
    };
    EXPECT_TRUE(becomesTrue([&, before = pictures()] { return pictures() > before + 1; }));
    run.signal(SIGINT);
    EXPECT_THAT(run.wait(), succeeds());
}

TEST_F(MavlinkRunTest, TheDeploymentIsValidAndErrorsAreReportedWithTheirPlace) {
    INSONIFY_NEEDS("sdf");
    EXPECT_EQ(callInsonify(folder, {"check", deployment}).code, 0);
    const auto diagnosed = [&](const std::string& set) {
        return callInsonify(folder, {"run", deployment, "--out", "out", "--set", set}).err;
    };
    EXPECT_THAT(diagnosed("vehicles.port=70000"), HasSubstr("vehicles.properties.port: is 70000; may be 0 to 65535"));
    EXPECT_THAT(diagnosed("vehicles.bodies=[{port: red, source: gps}, {port: blue}]"),
                HasSubstr("bodies[0].source: is gps; "));
    EXPECT_THAT(diagnosed("vehicles.bodies=[{port: red}, {port: red}]"),
                HasSubstr("bodies[1].port: is red a second time"));
    EXPECT_THAT(diagnosed("vehicles.bodies=[{port: red, system_id: 0}, {port: blue}]"),
                HasSubstr("bodies[0].system_id: is 0; may be 1 to 255"));
    EXPECT_THAT(diagnosed("vehicles.bodies=[]"), HasSubstr("bodies: is empty; must hold a body"));
    EXPECT_THAT(diagnosed("vehicles.request={rate: 0}"), HasSubstr("request.rate: is 0 Hz; may be 2 to 1000 Hz"));
}

TEST_F(MavlinkRunTest, LockstepDoesNotReadPoses) {
    std::string text = readFile(deployment);
    text.replace(text.find("realtime"), 8, "lockstep");
    text.replace(text.find("scenes/"), 7, test::sourceFile("deploy/scenes/"));
    writeFile(folder / "x.yml", text);
    EXPECT_THAT(callInsonify(folder, {"check", "x.yml"}),
                isRefused(HasSubstr("tasks.vehicles.properties: messages arrive by the wall clock")));
}
