#include <gmock/gmock.h>

#include <algorithm>
#include <map>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

TEST(CheckCommandTest, AValidDeploymentIsPrintedAsAGraph) {
    const WallFolder folder;
    EXPECT_THAT(callInsonify(folder, {"check", "wall.yml"}),
                prints(AllOf(HasSubstr("wall.yml: valid, lockstep, 5 tasks, 6 connections\n"),
                             HasSubstr("vehicle (pose::TrajectoryTask, every 0.1 s)\n"),
                             HasSubstr("  noisy -> log.noisy  /base/samples/Sonar, buffer 64\n"))));
}

TEST(CheckCommandTest, RefusesCodesOfTasksThatSendNone) {
    const std::string receiver = "  receiver: {type: receiver::ReceiverTask, properties: {}}\n",
                      xtf = "  xtf: {type: output::XtfTask, properties: {}}\n",
                      fan = "  fan: {type: output::FanImageTask, properties: {file: fan_%06d.png, scale: code}}\n";
    const std::string placed = "  - {from: sonar.pose, to: xtf.pose}\n";
    const auto deployment = [&](const std::string& from, const std::string& output) {
        return replaced(wall_deployment, "  log:\n", replaced(receiver, "{}", output) + xtf + fan + "  log:\n") +
               "  - {from: noise.noisy, to: receiver.intensity}\n" + placed + "  - {from: " + from +
               ", to: xtf.ping}\n" + "  - {from: " + from + ", to: fan.ping}\n";
    };
    const std::map<std::string, std::string> refused = {
        {deployment("sonar.ping", "{output: code}"), "sonar sends intensities"},
        {deployment("noise.noisy", "{output: code}"), "sonar sends intensities"},
        {deployment("receiver.ping", "{output: level_db}"), "the output of receiver is level_db"},
        {deployment("receiver.ping", "{}"), "the output of receiver is intensity"}};
    for (const auto& [text, why] : refused) {
        const WallFolder folder(text);
        const Outcome outcome = callInsonify(folder, {"check", "wall.yml"});
        EXPECT_THAT(outcome, isRefused(AllOf(HasSubstr("tasks.xtf.properties.samples: is uint16, which takes whole "
                                                       "numbers from 0 to 65535, but " +
                                                       why),
                                             HasSubstr("tasks.fan.properties.scale: is code, but " + why))));
        EXPECT_EQ(folder.run().code, 2);
        EXPECT_FALSE(fs::exists(folder / "out"));
    }
    const WallFolder coded(deployment("receiver.ping", "{output: code, code: {bits: 16}}"));
    EXPECT_THAT(callInsonify(coded, {"check", "wall.yml"}), succeeds());
}

TEST(CheckCommandTest, JsonHasTasksAndConnections) {
    const WallFolder folder;
    const json reported = json::parse(callInsonify(folder, {"check", "wall.yml", "--json"}).out);
    EXPECT_TRUE(reported["valid"]);
    EXPECT_EQ(reported["errors"], json::array());
    EXPECT_EQ(reported["warnings"], json::array());
    EXPECT_EQ(reported["tasks"].size(), 5u);
    EXPECT_EQ(reported["tasks"][2]["name"], "sonar");
    EXPECT_EQ(reported["tasks"][2]["type"], "sonar::SonarTask");
    EXPECT_EQ(reported["connections"][4]["from"], "noise.noisy");
    EXPECT_EQ(reported["connections"][4]["to"], "log.noisy");
    EXPECT_EQ(reported["connections"][4]["policy"]["size"], 64);
}

TEST(CheckCommandTest, WarnsOfKeysThatTheScheduleIgnores) {
    const std::string text = replaced(wall_deployment, "{trigger: [snapshot]}",
                                      "{trigger: [snapshot], scheduler: fifo, priority: 5, deadline: 0.1}");
    const WallFolder folder("lock_memory: true\n" + text);
    EXPECT_THAT(callInsonify(folder, {"check", "wall.yml"}),
                prints(AllOf(HasSubstr("warning: not used in lockstep: lock_memory\n"),
                             HasSubstr("warning: sonar: not used in lockstep: scheduler, deadline\n"))));
    const Outcome run = callInsonify(folder, {"run", "wall.yml", "--pings", "1"});
    EXPECT_THAT(run.err, HasSubstr("warning: sonar: not used in lockstep: scheduler, deadline\n"));
}

TEST(CheckCommandTest, SetChangesTheDeploymentAsInARun) {
    const WallFolder folder;
    EXPECT_EQ(callInsonify(folder, {"check", "wall.yml", "--set", "sonar.range=15"}).code, 0);
    EXPECT_THAT(callInsonify(folder, {"check", "wall.yml", "--set", "sonar.range=-15"}),
                isRefused(HasSubstr("--set: tasks.sonar.properties.range: is -15")));
}

TEST(CheckCommandTest, AnErrorInABlockOfSetHasThePathOfItsKey) {
    const WallFolder folder;
    const std::map<std::string, std::string> errors = {
        {"volume={strengh_db: -70}", "volume.strengh_db: is not a key here; did you mean strength_db?"},
        {"multipath={bounces: 3}", "multipath.bounces: is 3; may be 0 to 2"},
        {"pulse={bandwidth_khz: 50, ring_down: {level_db: -20}}", "pulse.ring_down.decay_db_per_m: is missing"},
        {"beam_pattern={transmit: {azimuth: {width_deg: -1}}}", "beam_pattern.transmit.azimuth.width_deg: is -1 deg"},
        {"water={depth: [1, 2]}", "water.depth: is a list"},
        {"water=5", "water: is 5; must be a block of keys and values, such as {temperature_celsius: "},
        {"beam_pattern=3", "beam_pattern: is 3; must be a block of keys and values, such as {"},
        {"targets=3", "targets: is not a key here"},
    };
    for (const auto& [set, error] : errors)
        EXPECT_THAT(callInsonify(folder, {"check", "wall.yml", "--set", "sonar." + set}),
                    isRefused(testing::StartsWith("--set: tasks.sonar.properties." + error)));
}

TEST(CheckCommandTest, ReadsTheTablesOfASonar) {
    const WallFolder folder(replaced(wall_deployment, "range: 20",
                                     "range: 20\n      water: {profile: speeds.csv}\n"
                                     "      beam_pattern: {receive: {azimuth: {file: beam.csv}}}"));
    const auto errors = [&] { return callInsonify(folder, {"check", "wall.yml"}); };
    EXPECT_THAT(errors(),
                isRefused(testing::AllOf(
                    HasSubstr("wall.yml:17:24: tasks.sonar.properties.water.profile: ./speeds.csv: does not exist"),
                    HasSubstr("wall.yml:18:48: tasks.sonar.properties.beam_pattern.receive.azimuth.file: ./beam.csv: "
                              "does not exist"))));
    writeFile(folder / "speeds.csv", "depth_m,sound_speed_m_s\n0,1500\n5,abc\n");
    writeFile(folder / "beam.csv", "angle_deg,level_db\n10,0\n20,-3\n");
    EXPECT_THAT(errors(),
                isRefused(testing::AllOf(HasSubstr("water.profile: ./speeds.csv:3:3: sound_speed_m_s: is 'abc'"),
                                         HasSubstr("azimuth.file: ./beam.csv: angle_deg: does not include 0"))));
    writeFile(folder / "speeds.csv", "depth_m,sound_speed_m_s\n0,1500\n5,1490\n");
    writeFile(folder / "beam.csv", "angle_deg,level_db\n-20,-3\n0,0\n20,-3\n");
    EXPECT_EQ(errors().code, 0);
}

TEST(CheckCommandTest, ADeploymentWithoutTasksIsOneError) {
    const WallFolder folder(replaced(wall_deployment, "tasks:\n", "task:\n"));
    const Outcome outcome = callInsonify(folder, {"check", "wall.yml"});
    EXPECT_THAT(outcome, isRefused(HasSubstr("did you mean tasks?")));
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
}

TEST(CheckCommandTest, JsonHasEveryErrorWithItsPlace) {
    const WallFolder folder(replaced(wall_deployment, "range: 20", "range: -20"));
    const Outcome outcome = callInsonify(folder, {"check", "wall.yml", "--json"});
    EXPECT_EQ(outcome.code, 2);
    const json reported = json::parse(outcome.out);
    EXPECT_FALSE(reported["valid"]);
    ASSERT_EQ(reported["errors"].size(), 1u);
    const json& error = reported["errors"][0];
    EXPECT_EQ(error["file"], "wall.yml");
    EXPECT_EQ(error["line"], 16);
    EXPECT_EQ(error["column"], 14);
    EXPECT_EQ(error["path"], "tasks.sonar.properties.range");
    EXPECT_NE(error["message"], "");
}
