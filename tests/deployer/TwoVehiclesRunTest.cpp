// Two vehicles in one SDF world: each sonar receives its first echo from the other's hull at its range.
#include <gmock/gmock.h>

#include "tests/deployer/SceneRun.hpp"
#include "tests/support/Needs.hpp"

using namespace insonify::deployer;
using insonify::types::Sonar;

namespace {

const char* const world = R"(<sdf version="1.9"><world name="w">
<model name="red"><link name="hull"><visual name="v"><geometry><box><size>2 2 2</size></box></geometry></visual></link></model>
<model name="blue"><link name="hull"><visual name="v"><geometry><box><size>4 2 2</size></box></geometry></visual></link></model>
</world></sdf>)";

// Bins are 100 us at 1000 m/s: 0.1 m. Blue is 20 m in front of red and looks back at it.
const char* const two_vehicles = R"(tasks:
  red:  {type: pose::TrajectoryTask, activity: {period: 0.1}, properties: {waypoints: [{time: 0, position: [5, 0, -3], yaw_deg: 90}]}}
  blue: {type: pose::TrajectoryTask, activity: {period: 0.1}, properties: {waypoints: [{time: 0, position: [5, 20, -3], yaw_deg: -90}]}}
  red_scene:  {type: scene::SceneTask, activity: {trigger: [pose]}, properties: {file: case.world, mount: {position: [1.5, 0, 0]}}}
  blue_scene: {type: scene::SceneTask, activity: {trigger: [pose]}, properties: {file: case.world, mount: {position: [3, 0, 0]}}}
  red_sonar:  {type: sonar::SonarTask, activity: {trigger: [snapshot]}, properties: &sonar {speed_of_sound: 1000, range: 20, bin_count: 200, beam_count: 1, field_of_view_deg: 2, beam_height_deg: 4}}
  blue_sonar: {type: sonar::SonarTask, activity: {trigger: [snapshot]}, properties: *sonar}
  log: {type: logger::LoggerTask, properties: {file: x.0.log}}
connections:
  - {from: red.pose,  to: red_scene.pose}
  - {from: red.pose,  to: red_scene.red.pose}
  - {from: blue.pose, to: red_scene.blue.pose}
  - {from: blue.pose, to: blue_scene.pose}
  - {from: red.pose,  to: blue_scene.red.pose}
  - {from: blue.pose, to: blue_scene.blue.pose}
  - {from: red_scene.snapshot,  to: red_sonar.snapshot}
  - {from: blue_scene.snapshot, to: blue_sonar.snapshot}
  - {from: red_sonar.ping,  to: log.red,  policy: {type: buffer, size: 8}}
  - {from: blue_sonar.ping, to: log.blue, policy: {type: buffer, size: 8}}
)";

size_t firstEcho(const Sonar& ping) {
    return static_cast<size_t>(std::ranges::find_if(ping.bins, [](float bin) { return bin > 0; }) - ping.bins.begin());
}

}  // namespace

TEST(TwoVehiclesRunTest, EachReceivesTheOthersEchoAtItsRange) {
    INSONIFY_NEEDS("sdf");
    const TestFolder folder;
    writeFile(folder / "case.world", world);
    writeFile(folder / "two.yml", two_vehicles);
    ASSERT_THAT(callInsonify(folder, {"run", "two.yml", "--pings", "2", "--out", "out"}), succeeds());
    // sonars are 1.5 and 3 m in front of their hulls' middles, the other's bow is 2 and 1 m in front of its own: 16.5
    // and 16 m
    EXPECT_EQ(firstEcho(exportedPings(folder, "out/x.0.log", "red_sonar.ping").back()), 165u);
    EXPECT_EQ(firstEcho(exportedPings(folder, "out/x.0.log", "blue_sonar.ping").back()), 160u);
}

TEST(TwoVehiclesRunTest, ReportsPosesReplacedByNewerPosesAndLosses) {
    INSONIFY_NEEDS("sdf");
    const TestFolder folder;
    writeFile(folder / "case.world", world);
    std::string often = replaced(two_vehicles, "blue: {type: pose::TrajectoryTask, activity: {period: 0.1}",
                                 "blue: {type: pose::TrajectoryTask, activity: {period: 0.05}");
    often = replaced(often, "to: red_scene.blue.pose}", "to: red_scene.blue.pose, policy: {type: buffer, size: 8}}");
    writeFile(folder / "two.yml", often);
    const Outcome run = callInsonify(
        folder, {"run", "two.yml", "--pings", "3", "--out", "out", "--summary", "summary.json", "--verbose"});
    ASSERT_EQ(run.code, 0) << run.err;
    // Two poses of blue arrive between two of red, each of which uses the newer one.
    EXPECT_THAT(run.out, testing::HasSubstr("skipped for newer samples\n       2  blue.pose>red_scene.blue.pose\n"));
    EXPECT_THAT(run.out, testing::Not(testing::HasSubstr("lost samples")));
    EXPECT_THAT(run.out, testing::ContainsRegex("\n  not configured: [a-z_]+, [a-z_]+"));
    EXPECT_THAT(run.out, testing::Not(testing::HasSubstr(": not configured")));
    const json summary = json::parse(readFile(folder / "summary.json"));
    EXPECT_EQ(summary["passed_over"]["blue.pose>red_scene.blue.pose"], 2);
    EXPECT_EQ(summary["losses"]["blue.pose>red_scene.blue.pose"], 0);
    EXPECT_EQ(summary["passed_over"]["red.pose>red_scene.pose"], 0);
}

TEST(TwoVehiclesRunTest, WithoutPosesTheOtherVehicleIsAtItsPlaceInTheWorld) {
    INSONIFY_NEEDS("sdf");
    const TestFolder folder;
    writeFile(folder / "case.world", world);
    std::string alone = two_vehicles;
    alone = replaced(alone, "  - {from: blue.pose, to: red_scene.blue.pose}\n", "");
    writeFile(folder / "two.yml", alone);
    ASSERT_EQ(callInsonify(folder, {"run", "two.yml", "--pings", "2", "--out", "out"}).code, 0);
    const Sonar ping = exportedPings(folder, "out/x.0.log", "red_sonar.ping").back();
    EXPECT_EQ(firstEcho(ping), ping.bins.size());
}

TEST(TwoVehiclesRunTest, RefusesAPortOfAMissingModel) {
    INSONIFY_NEEDS("sdf");
    const TestFolder folder;
    writeFile(folder / "case.world", world);
    writeFile(folder / "two.yml", replaced(two_vehicles, "red_scene.blue.pose", "red_scene.green.pose"));
    const Outcome outcome = callInsonify(folder, {"check", "two.yml"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.err.find("green.pose"), std::string::npos) << outcome.err;
}
