// Export of logs to files of sonar recorders: XTF of side-scans, as PyPI's pyxtf reads it, and .oculus.
#include <gmock/gmock.h>

#include "components/log/Reader.hpp"
#include "tests/deployer/Wall.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"

using namespace insonify::deployer;
using namespace insonify;
using testing::AllOf;
using testing::HasSubstr;

namespace {

/** A side-scan that passes the wall, as an XTF file and as a log: its codes and poses, the clean pings and the
 *  vehicle's poses. */
const std::string sidescan_deployment = R"(start_time: 1700000000.5
tasks:
  vehicle:
    type: pose::TrajectoryTask
    activity: {period: 0.1}
    properties: {waypoints: [{time: 0, position: [6, -3, 1], yaw_deg: 80}, {time: 1, position: [6, 1, 1], yaw_deg: 90}]}
  scene: {type: scene::SceneTask, properties: {file: wall.gltf, mount: {position: [0.5, 0, -0.25], yaw_deg: 4}}}
  sonar:
    type: sonar::SideScanTask
    properties: {range: 15, bin_count: 200, frequency_khz: 450, quality: {rows: 4, columns_per_beam: 256}}
  noise: {type: noise::NoiseTask, properties: {seed: 7, speckle: {law: rayleigh}, ambient: {level_db: -60}}}
  receiver: {type: receiver::ReceiverTask, properties: {output: code, code: {bits: 16, law: sqrt, full_scale_db: -20}}}
  xtf: {type: output::XtfTask, properties: {file: lines.xtf, frequency_khz: 450}}
  log: {type: logger::LoggerTask, properties: {file: lines.0.log}}
connections:
  - {from: vehicle.pose,   to: scene.pose}
  - {from: scene.snapshot, to: sonar.snapshot}
  - {from: sonar.ping,     to: noise.clean}
  - {from: noise.noisy,    to: receiver.intensity}
  - {from: receiver.ping,  to: xtf.ping,     policy: {type: buffer, size: 64}}
  - {from: sonar.pose,     to: xtf.pose,     policy: {type: buffer, size: 64}}
  - {from: receiver.ping,  to: log.ping,     policy: {type: buffer, size: 64}}
  - {from: noise.noisy,    to: log.noisy,    policy: {type: buffer, size: 64}}
  - {from: sonar.pose,     to: log.pose,     policy: {type: buffer, size: 64}}
  - {from: vehicle.pose,   to: log.vehicle,  policy: {type: buffer, size: 64}}
)";

struct DeviceExportTest : testing::Test {
    void SetUp() override {
        writeFile(folder_ / "wall.yml", sidescan_deployment);
        ASSERT_THAT(folder_.run({"--pings", "6"}), succeeds());
    }
    /** Runs `log export` on the run's log. */
    Outcome toFile(const std::string& stream, const std::string& to, std::vector<std::string> more = {},
                   const std::string& log = "out/lines.0.log") const {
        std::vector<std::string> words = {"log", "export", log, "--to", to};
        if (!stream.empty()) words.insert(words.end(), {"--stream", stream});
        words.insert(words.end(), more.begin(), more.end());
        return callInsonify(folder_, words);
    }
    json readXtf(const std::string& name) const {
        return json::parse(pythonSays(test::sourceFile("tests/recordings/read_xtf.py ") + (folder_ / name).string(),
                                      folder_ / "answer"));
    }
    void expectRefused(const std::string& stream, const std::string& to, std::vector<std::string> more,
                       const std::string& why, const std::string& log = "out/lines.0.log") const {
        EXPECT_THAT(toFile(stream, to, std::move(more), log), isRefused(HasSubstr(why)));
        EXPECT_FALSE(fs::exists(folder_ / to));
    }

    const WallFolder folder_;
};

}  // namespace

TEST_F(DeviceExportTest, ALogExportsTheXtfFileOfItsRun) {
    ASSERT_THAT(toFile("receiver.ping", "lines.xtf"), prints("lines.xtf\n"));
    const std::string exported = readFile(folder_ / "lines.xtf");
    EXPECT_EQ(exported.size() % 64, 0u);
    EXPECT_EQ(exported.size(), 1024 + 6 * ((256 + 2 * (64 + 200 * 2) + 63) / 64 * 64));
    EXPECT_TRUE(exported == readFile(folder_ / "out/lines.xtf"));
}

TEST_F(DeviceExportTest, PyxtfReadsTheLinesOfALogWithTheirPositions) {
    if (!pythonHas("pyxtf")) GTEST_SKIP() << "SKIPPED: the Python package pyxtf is missing; scripts/setup installs it";
    ASSERT_EQ(toFile("receiver.ping", "lines.xtf").code, 0);
    const json file = readXtf("lines.xtf");
    ASSERT_EQ(file["pings"].size(), 6u);
    EXPECT_EQ(file["channels"][0][1], 450);
    const auto log = log::openLog(folder_ / "out/lines.0.log");
    std::vector<types::Sonar> pings;
    log->forEach<types::Sonar>("receiver.ping", [&](const auto& ping, const auto&) { pings.push_back(ping); });
    std::vector<types::Pose> poses;
    log->forEach<types::Pose>("sonar.pose", [&](const auto& pose, const auto&) { poses.push_back(pose); });
    for (size_t i = 0; i < 6; ++i) {
        const json& line = file["pings"][i];
        EXPECT_EQ(line["time"],
                  "2023-11-14T22:13:2" + std::to_string(i < 5 ? 0 : 1) + "." + std::to_string((5 + i) % 10) + "00");
        EXPECT_NEAR(line["slant_range"], pings[i].binStart(200), 1e-4);
        EXPECT_EQ(line["x_y"], (json{-poses[i].position.y, poses[i].position.x}));
        std::vector<float> starboard(pings[i].bins.begin(), pings[i].bins.begin() + 200);
        std::vector<float> port(pings[i].bins.rbegin(), pings[i].bins.rbegin() + 200);
        EXPECT_EQ(line["stbd"].get<std::vector<float>>(), starboard);
        EXPECT_EQ(line["port"].get<std::vector<float>>(), port) << "from the far end";
        EXPECT_GT(*std::ranges::max_element(port), 100) << "the wall is to port";
    }
}

TEST_F(DeviceExportTest, AnMcapFileGivesTheSameLines) {
    if (!pythonHas("pyxtf")) GTEST_SKIP() << "SKIPPED: the Python package pyxtf is missing; scripts/setup installs it";
    ASSERT_EQ(toFile("", "lines.mcap").code, 0);
    ASSERT_THAT(toFile("/receiver/ping", "bag.xtf", {"--pose", "/sonar/pose"}, "lines.mcap"), succeeds());
    ASSERT_EQ(toFile("receiver.ping", "lines.xtf").code, 0);
    const json bag = readXtf("bag.xtf"), lines = readXtf("lines.xtf");
    ASSERT_EQ(bag["pings"].size(), 6u);
    for (size_t i = 0; i < 6; ++i) {
        for (const char* same : {"port", "stbd", "time", "slant_range", "number"})
            EXPECT_EQ(bag["pings"][i][same], lines["pings"][i][same]) << same;
        for (const size_t axis : {0u, 1u})
            EXPECT_NEAR(bag["pings"][i]["x_y"][axis], lines["pings"][i]["x_y"][axis], 1e-9);
        EXPECT_NEAR(bag["pings"][i]["heading"], lines["pings"][i]["heading"], 1e-3);
    }
}

TEST_F(DeviceExportTest, ConvertsPosesOfTheVehicleToItsSonar) {
    if (!pythonHas("pyxtf")) GTEST_SKIP() << "SKIPPED: the Python package pyxtf is missing; scripts/setup installs it";
    ASSERT_EQ(toFile("receiver.ping", "sonar.xtf", {"--pose", "sonar.pose"}).code, 0);
    ASSERT_EQ(toFile("receiver.ping", "vehicle.xtf", {"--pose", "vehicle.pose"}).code, 0);
    const json sonar = readXtf("sonar.xtf"), vehicle = readXtf("vehicle.xtf");
    for (size_t i = 0; i < 6; ++i) {
        for (const size_t axis : {0u, 1u})
            EXPECT_NEAR(sonar["pings"][i]["x_y"][axis], vehicle["pings"][i]["x_y"][axis], 1e-9);
        EXPECT_NEAR(sonar["pings"][i]["heading"], vehicle["pings"][i]["heading"], 1e-4);
        EXPECT_NEAR(sonar["pings"][i]["depth"], vehicle["pings"][i]["depth"], 1e-6);
    }
}

TEST_F(DeviceExportTest, BinsThatAreNotCodesAreUnchanged) {
    if (!pythonHas("pyxtf")) GTEST_SKIP() << "SKIPPED: the Python package pyxtf is missing; scripts/setup installs it";
    ASSERT_EQ(toFile("noise.noisy", "noisy.xtf").code, 0);
    const json file = readXtf("noisy.xtf");
    types::Sonar ping;
    const auto log = log::openLog(folder_ / "out/lines.0.log");
    log->forEach<types::Sonar>("noise.noisy", [&](const auto& sample, const auto&) { ping = sample; });
    const std::vector<float> starboard(ping.bins.begin(), ping.bins.begin() + 200);
    EXPECT_EQ(file["pings"][5]["stbd"].get<std::vector<float>>(), starboard);
}

TEST_F(DeviceExportTest, AnXtfFileIsImportedAgainBinByBin) {
    ASSERT_THAT(callInsonify(folder_, {"log", "import", "out/lines.xtf", "--to", "again.0.log"}),
                prints("again.0.log: 6 pings as receiver.ping\n"));
    const auto getPings = [&](const char* log) {
        std::vector<types::Sonar> pings;
        log::openLog(folder_ / log)->forEach<types::Sonar>("receiver.ping", [&](const auto& ping, const auto&) {
            pings.push_back(ping);
        });
        return pings;
    };
    const auto getPoses = [&](const char* log) {
        std::vector<types::Pose> poses;
        log::openLog(folder_ / log)->forEach<types::Pose>("sonar.pose", [&](const auto& pose, const auto&) {
            poses.push_back(pose);
        });
        return poses;
    };
    const std::vector<types::Sonar> before = getPings("out/lines.0.log"), after = getPings("again.0.log");
    const std::vector<types::Pose> placed = getPoses("out/lines.0.log"), read = getPoses("again.0.log");
    ASSERT_EQ(after.size(), 6u);
    ASSERT_EQ(read.size(), 6u);
    for (size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(after[i].bins, before[i].bins);
        EXPECT_EQ(after[i].time, before[i].time);
        EXPECT_EQ(after[i].bin_duration, before[i].bin_duration);
        EXPECT_NEAR(after[i].binStart(200), before[i].binStart(200), 1e-4);
        EXPECT_EQ(read[i].time, placed[i].time);
        EXPECT_LT(glm::length(read[i].position - placed[i].position), 1e-6);
        EXPECT_GT(std::abs(glm::dot(read[i].orientation, placed[i].orientation)), 1 - 1e-9);
    }
}

TEST_F(DeviceExportTest, AnXtfFileIsRenderedAgainAndScored) {
    ASSERT_EQ(callInsonify(folder_, {"log", "import", "out/lines.xtf", "wall.yml", "--to", "again.0.log"}).code, 0);
    ASSERT_THAT(
        callInsonify(folder_, {"replay", "again.0.log", "wall.yml", "--rerender", "--score", "--out", "scored"}),
        succeeds());
    const json score = json::parse(readFile(folder_ / "scored/score.json"))["streams"][0];
    EXPECT_EQ(score["stream"], "receiver.ping");
    EXPECT_EQ(score["compared"], 6);
    for (const json& ping : score["pings"]) EXPECT_LT(ping["rel_l2"], 0.01) << "poses of the file are floats";
}

TEST_F(DeviceExportTest, ALogWithoutPosesGivesLinesWithoutPositionsAndANotice) {
    ASSERT_EQ(
        callInsonify(folder_, {"log", "cut", "out/lines.0.log", "--to", "pings.0.log", "--stream", "receiver.ping"})
            .code,
        0);
    const Outcome outcome = toFile("receiver.ping", "pings.xtf", {}, "pings.0.log");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_THAT(outcome.err, HasSubstr("notice: pings.0.log holds no poses: the lines have no positions"));
}

TEST_F(DeviceExportTest, RefusesStreamsThatAreNotASideScan) {
    expectRefused("sonar.pose", "x.xtf", {},
                  "sonar.pose: holds /base/samples/RigidBodyState_m; an XTF file takes the lines");
    expectRefused("no.ping", "x.xtf", {}, "no.ping");
    expectRefused("receiver.ping", "x.xtf", {"--pose", "receiver.ping"}, "--pose takes poses");
    expectRefused("receiver.ping", "x.xtf", {"--pose", "vehicle.pos"}, "vehicle.pos");
    expectRefused("receiver.ping", "out/lines.0.log/x.xtf", {},
                  "out/lines.0.log: --to: is no folder and cannot be made");
    const WallFolder wall;
    ASSERT_EQ(wall.run({"--pings", "1"}).code, 0);
    expectRefused("sonar.ping", "x.xtf", {},
                  "sonar.ping: holds pings of 16 beams; an XTF file takes the lines of a side-scan",
                  wall / "out/wall.0.log");
}

/** Returns the wall as recorded by a device with codes. */
std::string codedWall(const std::string& code) {
    std::string text = replaced(
        wall_deployment, "  log:\n",
        "  receiver: {type: receiver::ReceiverTask, properties: {output: code, code: " + code + "}}\n  log:\n");
    return replaced(text, "{from: noise.noisy, to: log.noisy, policy: {type: buffer, size: 64}}",
                    "{from: noise.noisy, to: receiver.intensity}\n"
                    "  - {from: receiver.ping, to: log.ping, policy: {type: buffer, size: 64}}");
}

TEST(OculusExportTest, ARecordingIsImportedAgainCodeByCode) {
    for (const char* code : {"{bits: 16, law: sqrt, full_scale_db: -40}", "{law: sqrt, full_scale_db: -40}"}) {
        const WallFolder folder(codedWall(code));
        ASSERT_EQ(folder.run({"--pings", "3"}).code, 0);
        ASSERT_THAT(callInsonify(folder, {"log", "export", "out/wall.0.log", "--stream", "receiver.ping", "--to",
                                          "dive.oculus"}),
                    succeeds());
        ASSERT_EQ(callInsonify(folder, {"log", "import", "dive.oculus", "wall.yml", "--to", "dive.0.log"}).code, 0);
        std::vector<types::Sonar> before, after;
        log::openLog(folder / "out/wall.0.log")
            ->forEach<types::Sonar>("receiver.ping", [&](const auto& ping, const auto&) { before.push_back(ping); });
        log::openLog(folder / "dive.0.log")->forEach<types::Sonar>("receiver.ping", [&](const auto& ping, const auto&) {
            after.push_back(ping);
        });
        ASSERT_EQ(after.size(), 3u);
        for (size_t i = 0; i < 3; ++i) {
            EXPECT_EQ(after[i].bins, before[i].bins) << code;
            EXPECT_GT(*std::ranges::max_element(after[i].bins), 10) << code;
            EXPECT_NEAR(after[i].time.seconds(), before[i].time.seconds(), 2e-6);
            for (size_t beam = 0; beam < after[i].bearings.size(); ++beam)
                EXPECT_NEAR(after[i].bearings[beam].deg(), before[i].bearings[beam].deg(), 0.0051);
            EXPECT_EQ(after[i].bin_duration, before[i].bin_duration);
        }
    }
}

TEST(OculusExportTest, CodesOfOtherWidthsAreScaledToSixteenBits) {
    const WallFolder folder(codedWall("{bits: 12, law: sqrt, full_scale_db: -40}"));
    ASSERT_EQ(folder.run({"--pings", "1"}).code, 0);
    ASSERT_EQ(
        callInsonify(folder, {"log", "export", "out/wall.0.log", "--stream", "receiver.ping", "--to", "a.oculus"}).code,
        0);
    ASSERT_EQ(callInsonify(folder, {"log", "import", "a.oculus", "--to", "a.0.log"}).code, 0);
    const auto logged = log::openLog(folder / "out/wall.0.log"), imported = log::openLog(folder / "a.0.log");
    types::Sonar before, after;
    logged->forEach<types::Sonar>("receiver.ping", [&](const auto& ping, const auto&) { before = ping; });
    imported->forEach<types::Sonar>("receiver.ping", [&](const auto& ping, const auto&) { after = ping; });
    ASSERT_EQ(after.bins.size(), before.bins.size());
    EXPECT_GT(*std::ranges::max_element(before.bins), 100);
    for (size_t i = 0; i < before.bins.size(); ++i)
        EXPECT_EQ(after.bins[i], std::round(before.bins[i] * 65535 / 4095)) << i;
}

TEST(OculusExportTest, RefusesPingsThatNoOculusSends) {
    const auto refusal = [](const std::string& code, const std::string& stream) {
        const WallFolder folder(codedWall(code));
        EXPECT_EQ(folder.run({"--pings", "1"}).code, 0);
        const Outcome outcome =
            callInsonify(folder, {"log", "export", "out/wall.0.log", "--stream", stream, "--to", "dive.oculus"});
        EXPECT_EQ(outcome.code, 2);
        EXPECT_FALSE(fs::exists(folder / "dive.oculus"));
        return outcome.err;
    };
    EXPECT_THAT(refusal("{law: sqrt}", "sonar.ping"),
                AllOf(HasSubstr("sonar.ping: holds intensity"), HasSubstr("output: code and code: {law: sqrt}")));
    EXPECT_THAT(refusal("{law: sqrt}", "vehicle.pose"), HasSubstr("vehicle.pose: holds /base/samples/RigidBodyState"));
    EXPECT_THAT(refusal("{bits: 8}", "receiver.ping"), HasSubstr("holds codes of law log"));
    EXPECT_THAT(refusal("{law: sqrt, gamma: 2}", "receiver.ping"), HasSubstr("holds codes of gamma 2"));
}
