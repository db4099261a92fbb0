// Invalid sweeps of insonify dataset.
#include <gmock/gmock.h>

#include "tests/dataset/HarbourDeployment.hpp"
#include "tests/deployer/Command.hpp"

using namespace insonify::deployer;
using insonify::dataset::deployment;
using testing::HasSubstr;

namespace {

struct BadSweep {
    std::string name, text, message;
};

class BadSweepTest : public testing::TestWithParam<BadSweep> {};

TEST_P(BadSweepTest, IsRefusedAtItsPlace) {
    const TestFolder folder;
    writeFile(folder / "d.yml", deployment);
    writeFile(folder / "sweep.yml", GetParam().text);
    EXPECT_THAT(callInsonify(folder, {"dataset", "d.yml", "--sweep", "sweep.yml", "--out", "out"}),
                isRefused(HasSubstr(GetParam().message)));
    EXPECT_FALSE(fs::exists(folder / "out/manifest.json"));
}

const std::string grid = "poses: {grid: {x: [0, 1]}}\n";

TEST(BadSweepsTest, ASceneAsASettingIsOneError) {
    const TestFolder folder;
    writeFile(folder / "d.yml", deployment);
    writeFile(folder / "sweep.yml", grid + "settings: {scene.file: [none.glb]}\n");
    const Outcome outcome = callInsonify(folder, {"dataset", "d.yml", "--sweep", "sweep.yml", "--out", "out"});
    EXPECT_THAT(outcome, isRefused(HasSubstr("names the file of scene")));
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
}

TEST(BadSweepsTest, ValuesThatDoNotFitEachOtherAreNamedTogether) {
    const TestFolder folder;
    writeFile(folder / "d.yml", deployment);
    writeFile(folder / "sweep.yml",
              grid + "settings:\n  receiver.code.gamma: {uniform: [2, 2]}\n  receiver.code.law: [linear, log]\n");
    EXPECT_THAT(
        callInsonify(folder, {"dataset", "d.yml", "--sweep", "sweep.yml", "--out", "out", "--set",
                              "receiver.code.law=linear", "--set", "receiver.output=code"}),
        isRefused(HasSubstr("sweep.yml:3:24: settings.receiver.code.gamma: is given with law log; it bends law linear "
                            "and sqrt; receiver.code.law is log; receiver.code.gamma is 2")));
    writeFile(folder / "sweep.yml",
              grid + "settings:\n  receiver.code.law: [linear, log]\n  receiver.code.gamma: [1, 2]\n");
    EXPECT_THAT(callInsonify(folder, {"dataset", "d.yml", "--sweep", "sweep.yml", "--out", "again", "--set",
                                      "receiver.code.law=linear", "--set", "receiver.output=code"}),
                isRefused(HasSubstr("sweep.yml:4:28: settings.receiver.code.gamma: is given with law log")))
        << "at the value of the sample";
}

INSTANTIATE_TEST_SUITE_P(
    All, BadSweepTest,
    testing::Values(
        BadSweep{"UnknownKey", grid + "setings: {}\n",
                 "sweep.yml:2:1: setings: is not a key here; did you mean settings?"},
        BadSweep{"NoPoses", "seed: 1\n", "poses: is missing; give grid, random or trajectory"},
        BadSweep{"TwoKindsOfPoses", "poses: {grid: {x: 1}, random: {count: 1}}\n",
                 "sweep.yml:1:8: poses: must have one of grid, random and trajectory"},
        BadSweep{"LinesOfAFan", grid + "lines: {speed: 1}\n",
                 "sweep.yml:2:8: lines: `lines` and `picture: {shape: waterfall}` go together: give both or neither"},
        BadSweep{"WaterfallOfOnePing", grid + "picture: {shape: waterfall}\n",
                 "sweep.yml:2:18: picture.shape: `lines` and `picture: {shape: waterfall}` go together"},
        BadSweep{"LinesWithoutSpeed", grid + "lines: {count: 3}\npicture: {shape: waterfall}\n",
                 "sweep.yml:2:8: lines.speed: is missing; give the speed of the vehicle straight ahead [m/s]"},
        BadSweep{
            "LinesOfAnotherSonar", grid + "lines: {speed: 1, count: 3}\npicture: {shape: waterfall}\n",
            "sweep.yml:2:8: lines: are of side-scans, whose pings have one or two beams; the pings of d.yml have "},
        BadSweep{"OneLine", grid + "lines: {speed: 1, count: 1}\npicture: {shape: waterfall}\n",
                 "sweep.yml:2:26: lines.count: is 1; may be 2 to 10000"},
        BadSweep{"ClassOfGhosts", grid + "classes: {ghost: hull}\nannotations: {ghosts: true}\n",
                 "sweep.yml: classes: has ghost, which is the class of shadows or ghosts; name it otherwise"},
        BadSweep{"EmptyGrid", "poses:\n  grid: {x: []}\n", "sweep.yml:2:13: poses.grid.x: is empty"},
        BadSweep{"DrawnGrid", "poses:\n  grid: {x: {uniform: [0, 1]}}\n",
                 "sweep.yml:2:13: poses.grid.x: is drawn at random"},
        BadSweep{"UnknownCoordinate", "poses:\n  grid: {yaw: 1}\n",
                 "sweep.yml:2:10: poses.grid.yaw: is not a key here; did you mean yaw_deg?"},
        BadSweep{"NoCount", "poses:\n  random: {x: 1}\n", "sweep.yml:2:11: poses.random: has no count"},
        BadSweep{"ListOfDrawn", "poses:\n  random: {count: 2, x: [1, 2]}\n",
                 "sweep.yml:2:25: poses.random.x: has several values"},
        BadSweep{"Split", grid + "split: {train: 0.9, val: 0.2}\n",
                 "sweep.yml:2:8: split: adds up to 1.1; train, val and test must add up to 1"},
        BadSweep{"NoScene", grid + "scenes: [harbor.glb]\n",
                 "sweep.yml:2:10: scenes[0]: is harbor.glb; there is no such file"},
        BadSweep{"SettingOfNoTask", grid + "settings: {sonr.range: [1]}\n",
                 "sweep.yml:2:25: settings.sonr.range[0]: sonr.range=1: there is no task sonr; did you mean sonar?"},
        BadSweep{
            "SettingOutOfBounds", grid + "settings:\n  sonar.range: [30, -5]\n",
            "sweep.yml:3:21: settings.sonar.range[1]: tasks.sonar.properties.range: is -5 m; may be 0.001 to 100000 m"},
        BadSweep{
            "SettingWithOneValue", grid + "settings: {sonar.range: 30}\n",
            "sweep.yml:2:25: settings.sonar.range: must be a list of values, or one of uniform, normal and choice"},
        BadSweep{"ChoiceOfOne", grid + "settings: {sonar.range: {choice: 30}}\n",
                 "sweep.yml:2:34: settings.sonar.range.choice: is 30; must be a list"},
        BadSweep{"CountThatIsNoRange", grid + "objects:\n  - {names: [rock_000], x: [0, 1], y: [0, 1], count: 3}\n",
                 "sweep.yml:3:54: objects[0].count: is 3; must be a list of two, [min, max]"},
        BadSweep{"TiltWithoutBounds",
                 grid + "objects:\n  - {names: [rock_000], x: [0, 1], y: [0, 1], roll_deg: [20]}\n",
                 "sweep.yml:3:57: objects[0].roll_deg: must be two numbers, [min, max]"},
        BadSweep{"TwoTurns",
                 grid + "objects:\n  - {names: [rock_000], x: [0, 1], y: [0, 1], yaw_deg: [0, 9], any_turn: true}\n",
                 "sweep.yml:3:56: objects[0].yaw_deg: is given with any_turn; only one may set the turn"},
        BadSweep{"TwoLaws", grid + "settings:\n  sonar.range: {uniform: [20, 30], choice: [20]}\n",
                 "sweep.yml:3:16: settings.sonar.range: must have one of uniform, normal and choice"},
        BadSweep{"NoLaw", grid + "settings:\n  sonar.range: {unifrm: [20, 30]}\n",
                 "sweep.yml:3:17: settings.sonar.range.unifrm: is not a key here; did you mean uniform?"},
        BadSweep{"LawWithoutBounds", grid + "settings:\n  sonar.range: {uniform: [30, 20]}\n",
                 "settings.sonar.range.uniform: must be [min, max], the min not above the max"},
        BadSweep{"EmptyChoice", grid + "settings:\n  sonar.range: {choice: []}\n",
                 "sweep.yml:3:25: settings.sonar.range.choice: is empty; give at least one value"},
        BadSweep{"ChoiceOutOfBounds", grid + "settings:\n  sonar.range: {choice: [30, -5]}\n",
                 "sweep.yml:3:30: settings.sonar.range.choice[1]: tasks.sonar.properties.range: is -5 m; may be"},
        BadSweep{"DrawnOutOfBounds", grid + "settings:\n  sonar.range: {uniform: [-9, -5]}\n",
                 "sweep.yml:3:16: settings.sonar.range: tasks.sonar.properties.range: is -"},
        BadSweep{"DrawnNumberThatIsNotWhole", grid + "settings:\n  sonar.bin_count: {uniform: [100, 200]}\n",
                 "; must be a whole number; use choice"},
        BadSweep{"DrawnMaterialThatIsNotThere",
                 grid + "settings:\n  scene.materials.snad.lambert_db: {uniform: [-30, -20]}\n",
                 "sweep.yml:3:36: settings.scene.materials.snad.lambert_db: "},
        BadSweep{"ChoiceThatLacksAValue", grid + "settings:\n  noise.speckle: {choice: [{law: k}]}\n",
                 "sweep.yml:3:28: settings.noise.speckle.choice[0]: tasks.noise.properties.speckle.shape: is absent"},
        BadSweep{"DrawnBudget", grid + "settings:\n  sonar.quality.budget_ms: {uniform: [5, 9]}\n",
                 "sweep.yml:3:28: settings.sonar.quality.budget_ms: budget_ms lets the speed of the machine decide"},
        BadSweep{"EmptySetting", grid + "settings: {sonar.range: []}\n", "settings.sonar.range: is empty"},
        BadSweep{"Budget", grid + "settings: {sonar.quality.budget_ms: [5]}\n",
                 "sweep.yml:2:38: settings.sonar.quality.budget_ms[0]: budget_ms lets the speed of the machine decide"},
        BadSweep{"BudgetInABlock", grid + "settings:\n  sonar.quality: [{rows: 64}, {budget_ms: 5}]\n",
                 "sweep.yml:3:31: settings.sonar.quality[1]: budget_ms lets the speed of the machine decide"},
        BadSweep{"BudgetOfAScene", grid + "scenes: [{set: {sonar.quality.budget_ms: 5}}]\n",
                 "sweep.yml:2:42: scenes[0].set.sonar.quality.budget_ms: budget_ms lets the speed of the machine"},
        BadSweep{"SceneAsASetting", grid + "settings: {scene.file: [tank.glb]}\n",
                 "sweep.yml:2:25: settings.scene.file[0]: names the file of scene, which sets the objects of the "
                 "scene; name it under scenes"},
        BadSweep{"SceneInASet", grid + "scenes: [{set: {scene.file: tank.glb}}]\n",
                 "sweep.yml:2:29: scenes[0].set.scene.file: names the file of scene"},
        BadSweep{
            "NoObject", grid + "objects:\n  - {names: [rok_000], x: [0, 1], y: [0, 1]}\n",
            "sweep.yml:3:5: objects[0].names[0]: is rok_000, which is no name in the scene; did you mean rock_000?"},
        BadSweep{"NoGround", grid + "objects:\n  - {names: [rock_000], x: [0, 1], y: [0, 1], ground: see_floor}\n",
                 "objects[0].ground[0]: is see_floor, which is no name in the scene; did you mean sea_floor?"},
        BadSweep{"NoRoom", grid + "objects:\n  - {names: [rock_*], x: [0, 2], y: [0, 2]}\n",
                 "sweep.yml:3:5: objects[0]: has room for "},
        BadSweep{"NoClass", grid + "classes:\n  wreck: hul\n",
                 "sweep.yml:3:3: classes.wreck[0]: is hul, which is no name"},
        BadSweep{"RangesOfAFan", grid + "picture: {shape: range}\n",
                 "sweep.yml:2:18: picture.shape: is range, a picture of 3-D sonars; the sonar of d.yml is not 3-D"},
        BadSweep{"ShadowsInARangeImage", grid + "picture: {shape: range}\nannotations: {shadows: true}\n",
                 "sweep.yml:3:24: annotations.shadows: is true; a range image shows the strongest return of each beam"},
        BadSweep{"Picture", grid + "picture: {shape: disc}\n",
                 "sweep.yml:2:18: picture.shape: is disc; may be fan, polar"},
        BadSweep{"Trajectory", "poses: {trajectory: {file: no.csv, count: 2}}\n",
                 "sweep.yml:1:21: poses.trajectory.file: no.csv: does not exist; must be a CSV file"},
        BadSweep{"NoYaml", "poses: {", "sweep.yml:"}),
    [](const auto& tested) { return tested.param.name; });

}  // namespace
