#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"
#include "tests/support/SpeckleRecording.hpp"

using namespace insonify::deployer;
using insonify::test::OculusMessage;
using testing::AnyOf;
using testing::HasSubstr;

namespace {

void record(const fs::path& file) { writeFile(file, insonify::test::recordedSpeckle()); }

/** The wall as a receiver gives it out in codes. */
std::string codedWall() {
    std::string text =
        replaced(replaced(wall_deployment, "beam_count: 16", "beam_count: 64"), "bin_count: 50", "bin_count: 128");
    const std::string receiver =
        "  receiver:\n    type: receiver::ReceiverTask\n    activity: {trigger: [intensity]}\n    properties: {output: "
        "code, "
        "code: {law: sqrt, gamma: 0.5}}\n";
    text.insert(text.find("connections:"), receiver);
    return text + "  - {from: sonar.ping, to: receiver.intensity}\n";
}

}  // namespace

TEST(LikenessCommandTest, WritesTablesJsonDiagramAndPictureAndJudges) {
    const WallFolder folder;
    record(folder / "pings.raw");
    writeFile(folder / "coded.yml", codedWall());
    const Outcome outcome =
        callInsonify(folder, {"study", "likeness", "coded.yml", "--real", "pings.raw", "--out", "report"});
    EXPECT_EQ(outcome.code, 1) << "a wall without noise looks like no recording\n" << outcome.out << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("FAIL  speckle contrast, apart by: "));
    EXPECT_THAT(outcome.out, HasSubstr("recorded_5"));
    const json report = json::parse(readFile(folder / "report/likeness.json"));
    ASSERT_EQ(report["pings"].size(), 5u) << "two recorded, the simulated one, two wrong forms";
    EXPECT_EQ(report["pings"][2]["name"], "simulated");
    EXPECT_EQ(report["pings"][2]["histogram"].size(), 256u);
    EXPECT_NEAR(report["pings"][0]["contrast"], 0.52, 0.03) << "codes are quantised";
    EXPECT_EQ(report["verdicts"].size(), 10u);
    for (const json& verdict : report["verdicts"]) EXPECT_THAT(verdict["verdict"], AnyOf("pass", "FAIL", "open"));
    EXPECT_THAT(readFile(folder / "report/likeness.csv"), HasSubstr("\nsimulated,"));
    EXPECT_THAT(readFile(folder / "report/profiles.csv"), HasSubstr("ping,range_share,mean_code,level_db"));
    EXPECT_THAT(readFile(folder / "report/fans.png").substr(1, 3), "PNG");
}

TEST(LikenessCommandTest, WithoutADeploymentItTellsOfTheRecordingsAlone) {
    const WallFolder folder;
    fs::create_directory(folder / "recordings");
    record(folder / "recordings/pings.raw");
    const Outcome outcome = callInsonify(folder, {"study", "likeness", "--real", "recordings", "--out", "report"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(json::parse(readFile(folder / "report/likeness.json"))["pings"].size(), 4u);
}

TEST(LikenessCommandTest, WhatCannotBeComparedIsRefused) {
    const WallFolder folder;
    record(folder / "pings.raw");
    Outcome outcome = callInsonify(folder, {"study", "likeness", "wall.yml", "--real", "pings.raw", "--out", "report"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("has no receiver that gives out codes"));
    outcome = callInsonify(folder, {"study", "likeness", "--real", "wall.yml", "--out", "report"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("wall.yml: holds no ping of an Oculus"));
    fs::create_directory(folder / "empty");
    outcome = callInsonify(folder, {"study", "likeness", "--real", "empty", "--out", "report"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("is a folder without a file"));
    const auto small = OculusMessage{}.bytes();
    writeFile(folder / "small.raw", std::string(small.begin(), small.end()));
    outcome = callInsonify(folder, {"study", "likeness", "--real", "small.raw", "--out", "report"});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.err, HasSubstr("has too few beams or bins to tell what it looks like"));
    EXPECT_FALSE(fs::exists(folder / "report")) << "nothing is written";
}
