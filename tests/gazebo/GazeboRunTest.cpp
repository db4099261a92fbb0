// deploy/gazebo_world.yml, and errors of other deployments as a user sees them.
#include <gmock/gmock.h>
#include <signal.h>

#include <memory>

#include "tests/deployer/Command.hpp"
#include "tests/gazebo/FortressScene.hpp"
#include "tests/gazebo/FortressWorld.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify;
using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

const std::string deployment = test::sourceFile("deploy/gazebo_world.yml");

struct GazeboRunTest : gazebo::OwnPartition {
    /** A world that offers its scene as Gazebo does, and publishes no poses by itself. */
    std::unique_ptr<gazebo::FortressWorld> makeWorld() const {
        auto world = std::make_unique<gazebo::FortressWorld>("/world/two_vehicles/pose/info");
        world->serve("/world/two_vehicles/scene/info", [](ignition::msgs::Scene& scene) {
            scene = gazebo::makeScene(test::sourceFile("deploy/scenes/two_vehicles.world"));
            return true;
        });
        return world;
    }
    Process run(const std::vector<std::string>& more) const {
        std::vector<std::string> words = {"run", deployment, "--out", "out"};
        words.insert(words.end(), more.begin(), more.end());
        return Process(insonifyWords(words), folder.path());
    }
    bool says(const std::string& text) const {
        return gazebo::becomesTrue([&] { return readFile(folder / "stderr.txt").find(text) != std::string::npos; });
    }
    TestFolder folder;
};

}  // namespace

TEST_F(GazeboRunTest, PosesOfAWorldInAnotherProcessBecomePings) {
    const auto world = makeWorld();
    const Process sonar = run({"--pings", "20", "--summary", "summary.json", "--set", "scene.pose_timeout=60"});
    int sent = 0;
    const auto publish = [&] {
        ++sent;
        world->publish(0.02 * sent, 0.01 * sent);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    };
    const bool pings = gazebo::becomesTrue([&] { return publish(), fs::exists(folder / "out/fan_000000.png"); });
    const bool ended = pings && gazebo::becomesTrue([&] { return publish(), fs::exists(folder / "summary.json"); });
    if (!ended) sonar.signal(SIGKILL);
    EXPECT_TRUE(ended);
    ASSERT_THAT(sonar.wait(), succeeds());
    EXPECT_GE(json::parse(readFile(folder / "summary.json"))["pings"], 20);
}

TEST_F(GazeboRunTest, PingsStopAndResumeWithTheWorld) {
    const auto world = makeWorld();
    const Process sonar = run({"--set", "scene.pose_timeout=2", "--set", "fan.every=1"});
    int sent = 0;
    const auto publish = [&](bool continues) {
        sent += continues ? 1 : 0;
        world->publish(0.02 * sent, 0.01 * sent);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    };
    const auto pictures = [&] {
        return std::distance(fs::directory_iterator(folder / "out"), fs::directory_iterator{});
    };
    EXPECT_TRUE(gazebo::becomesTrue([&] { return publish(true), fs::exists(folder / "out/fan_000003.png"); }));
    EXPECT_TRUE(gazebo::becomesTrue([&] {
        publish(false);
        return readFile(folder / "stderr.txt").find("no pose in the last 2 s (pose_timeout)") != std::string::npos;
    }));
    EXPECT_TRUE(gazebo::becomesTrue([&, before = pictures()] { return publish(true), pictures() > before + 2; }));
    sonar.signal(SIGINT);
    EXPECT_THAT(sonar.wait(), succeeds());
}

TEST_F(GazeboRunTest, ReportsAMissingWorldAndEnds) {
    EXPECT_THAT(callInsonify(folder, {"run", deployment, "--out", "out", "--set", "scene.gazebo.timeout=0.5"}),
                isRefused(AllOf(HasSubstr("gazebo.world: is two_vehicles; its service "
                                          "/world/two_vehicles/scene/info is not offered in partition " +
                                          partition + " within 0.5 s (timeout); "),
                                HasSubstr("deploy/gazebo_world.yml:16:"))));
}

TEST_F(GazeboRunTest, WaitsWithoutPosesAndReportsIt) {
    const auto world = makeWorld();
    const Process sonar = run({"--set", "scene.pose_timeout=0.2"});
    EXPECT_TRUE(says("warning: scene: scene.pose: waits for the first pose")) << readFile(folder / "stderr.txt");
    sonar.signal(SIGINT);
    EXPECT_EQ(sonar.wait().code, 0);
}

TEST_F(GazeboRunTest, TheDeploymentIsValidAndErrorsAreReportedWithTheirPlace) {
    const auto world = makeWorld();
    EXPECT_EQ(callInsonify(folder, {"check", deployment}).code, 0);
    const auto diagnosed = [&](const std::string& set) {
        return callInsonify(folder, {"run", deployment, "--out", "out", "--set", set}).err;
    };
    EXPECT_THAT(diagnosed("world.bodies=[{port: red}, {port: blue, entity: blue}]"),
                HasSubstr("bodies[0]: must have either an entity or an odometry"));
    EXPECT_THAT(diagnosed("world.bodies=[{port: red, entity: red}, {port: red, entity: blue}]"),
                HasSubstr("bodies[1].port: is red a second time"));
    EXPECT_THAT(diagnosed("world.pose_topic=/poses"),
                HasSubstr("world: must be given for the poses of entities, or pose_topic, but not both"));
    EXPECT_THAT(diagnosed("world.world_frame=ecef"), HasSubstr("world_frame: is ecef"));
    EXPECT_THAT(diagnosed("scene.file=a.glb"), HasSubstr("gazebo: is given, and file as well"));
}
