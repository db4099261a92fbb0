// Logs of Ping Viewer become logs that are exported, replayed, rendered again and scored: a Ping360's and a Ping1D's.
#include <gmock/gmock.h>

#include <cmath>

#include "components/device/ping/Ping1dEmulator.hpp"
#include "components/device/ping/Ping360Emulator.hpp"
#include "components/log/Reader.hpp"
#include "tests/deployer/Wall.hpp"
#include "tests/support/PingViewerRecording.hpp"
#include "types/samples/Range.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarSettings.hpp"

using namespace insonify::deployer;
using namespace insonify;
using testing::HasSubstr;

namespace {

/** A sonar of one beam that moves towards a wall, in codes of 8 bits. */
const std::string beam_deployment = R"(schedule: lockstep
tasks:
  vehicle:
    type: pose::TrajectoryTask
    activity: {period: 0.1}
    properties: {waypoints: [{time: 0, position: [0, 0, 0]}, {time: 10, position: [4, 0, 0]}]}
  scene:
    type: scene::SceneTask
    activity: {trigger: [pose]}
    properties: {file: wall.gltf}
  sonar:
    type: sonar::ScanningSonarTask
    activity: {trigger: [snapshot]}
    properties:
      range: 18
      bin_count: 600
      range_rounding: exact
      speed_of_sound: 1500
      beam_width_deg: 2
      beam_height_deg: 25
      quality: {rows: 32, columns_per_beam: 4}
      head: {left_deg: 9, right_deg: -9, step_deg: 1.8}
  receiver:
    type: receiver::ReceiverTask
    activity: {trigger: [intensity]}
    properties: {output: code, code: {bits: 8, law: log, full_scale_db: -20, dynamic_range_db: 80}}
  log: {type: logger::LoggerTask, properties: {file: wall.0.log}}
connections:
  - {from: vehicle.pose, to: scene.pose}
  - {from: scene.snapshot, to: sonar.snapshot}
  - {from: sonar.ping, to: receiver.intensity}
  - {from: receiver.ping, to: log.ping, policy: {type: buffer, size: 64}}
)";

/** Returns the same, driven by a device, which follows the wall clock. */
std::string drivenBy(const std::string& device) {
    const std::string text_of_clock = replaced(beam_deployment, "schedule: lockstep", "schedule: realtime");
    std::string text = replaced(text_of_clock, "  sonar:\n", "  device: {type: " + device + "}\n  sonar:\n");
    text = replaced(text, "\n      head: {left_deg: 9, right_deg: -9, step_deg: 1.8}", "");
    return replaced(text, "connections:\n",
                    "connections:\n"
                    "  - {from: device.settings, to: sonar.settings, policy: {type: buffer, size: 4}}\n"
                    "  - {from: device.settings, to: receiver.settings, policy: {type: buffer, size: 4}}\n"
                    "  - {from: receiver.ping, to: device.ping}\n");
}

/** Returns the same with an altimeter. */
std::string getSounder(std::string text) {
    text = replaced(text, "ScanningSonarTask", "AltimeterTask");
    text = replaced(text, "bin_count: 600", "bin_count: 200");
    if (text.find("head:") == text.npos) return text;
    return replaced(text, "\n      head: {left_deg: 9, right_deg: -9, step_deg: 1.8}", "");
}

struct BeamImportTest : testing::Test {
    /** Writes dive.bin of the pings of a run. @param makeMessage returns a ping's message */
    void record(const std::string& deployment, int count, auto&& makeMessage) const {
        writeFile(folder_ / "wall.yml", deployment);
        ASSERT_THAT(folder_.run({"--pings", std::to_string(count)}), succeeds());
        std::vector<test::RecordedBytes> parts{test::pingViewerHeader()};
        log::openLog(folder_ / "out/wall.0.log")
            ->forEach<types::Sonar>("receiver.ping", [&](const types::Sonar& ping, const auto&) {
                device::Bytes codes;
                for (const float bin : ping.bins) codes.push_back(static_cast<uint8_t>(bin));
                parts.push_back(test::pingViewerRecord(test::pingViewerTime(ping.time.seconds()),
                                                       pingBytes(makeMessage(ping, std::move(codes)))));
            });
        writeBytes(folder_ / "dive.bin", test::joinedBytes(parts));
    }
    void recordScan(int count) const {
        record(beam_deployment, count, [](const types::Sonar& ping, device::Bytes codes) {
            const auto angle = static_cast<uint16_t>(std::lround(200 - ping.bearings[0].deg() / 0.9));
            return device::Ping360DeviceData{1, angle, {0, 32, 1600, 750, 600}, std::move(codes)};  // to 18 m
        });
    }
    Outcome import(const std::vector<std::string>& deployment = {"wall.yml"}) const {
        std::vector<std::string> arguments{"log", "import", "dive.bin"};
        arguments.insert(arguments.end(), deployment.begin(), deployment.end());
        arguments.insert(arguments.end(), {"--to", "dive.0.log"});
        return callInsonify(folder_, arguments);
    }
    /** Expects that the pings of the log are rendered again. */
    void expectScore(size_t count, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"replay",  "dive.0.log", "wall.yml", "--rerender",
                                           "--score", "--out",      "scored"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_THAT(callInsonify(folder_, arguments), succeeds());
        const json all = json::parse(readFile(folder_ / "scored/score.json"));
        ASSERT_EQ(all["streams"].size(), 1u);
        EXPECT_EQ(all["streams"][0]["stream"], "receiver.ping");
        EXPECT_EQ(all["streams"][0]["compared"], count);
        EXPECT_EQ(all["streams"][0]["other_shape"], 0);
        for (const json& ping : all["streams"][0]["pings"]) EXPECT_LT(ping["rel_l2"], 1e-6) << ping.dump();
    }

    const WallFolder folder_{beam_deployment};
};

}  // namespace

TEST_F(BeamImportTest, AScanOfAPing360IsRenderedAgainAtItsBearings) {
    recordScan(12);
    writeFile(folder_ / "wall.yml", drivenBy("device::Ping360Task"));
    const Outcome outcome = import();
    ASSERT_THAT(outcome, prints("dive.0.log: 12 pings as receiver.ping\n"));
    EXPECT_THAT(outcome.err, HasSubstr("dive.bin: the log states no speed of sound: ranges are those at 1500 m/s"));
    EXPECT_EQ(callInsonify(folder_, {"log", "check", "dive.0.log"}).code, 0);
    const auto log = log::openLog(folder_ / "dive.0.log");
    int ping = 0;
    log->forEach<types::SonarSettings>("device.settings", [&](const types::SonarSettings& asked, const auto&) {
        const int step = ping <= 10 ? ping : 20 - ping;
        EXPECT_NEAR(asked.bearing.deg(), 9 - 1.8 * step, 1e-9) << ping;
        EXPECT_NEAR(asked.range, 18, 1e-6);
        EXPECT_EQ(asked.bin_count, 600u);
        EXPECT_EQ(asked.frequency_khz, 750);
        EXPECT_EQ(asked.gain_db, 0);
        ++ping;
    });
    EXPECT_EQ(ping, 12);
    expectScore(12);
    fs::remove_all(folder_ / "scored");
    expectScore(7, {"--from", "0.5"});
}

TEST_F(BeamImportTest, ProfilesOfAPing1DAreRenderedAgainAndItsDistancesAreRanges) {
    record(getSounder(beam_deployment), 5, [](const types::Sonar& ping, device::Bytes codes) {
        const auto distance = static_cast<uint32_t>(std::lround(1000 * (10 - 0.4 * (ping.time.seconds() - 1))));
        return device::Ping1dProfile{{distance, 95, 100, 1, 0, 18'000, 0}, std::move(codes)};
    });
    for (const bool is_driven : {true, false}) {
        SCOPED_TRACE(is_driven);
        std::string deployment = getSounder(is_driven ? drivenBy("device::Ping1dTask") : beam_deployment);
        // The least gain of the device is 0.6 of the amplitude.
        if (is_driven) deployment = replaced(deployment, "full_scale_db: -20", "full_scale_db: -24.436975");
        writeFile(folder_ / "wall.yml", deployment);
        fs::remove_all(folder_ / "scored");
        ASSERT_THAT(import(), prints("dive.0.log: 5 pings as receiver.ping\n"));
        std::vector<double> ranges;
        log::openLog(folder_ / "dive.0.log")
            ->forEach<types::Range>("sonar.range",
                                    [&](const types::Range& range, const auto&) { ranges.push_back(range.range); });
        EXPECT_THAT(ranges, testing::ElementsAre(10, 9.96, 9.92, 9.88, 9.84));
        expectScore(5);
    }
}

TEST_F(BeamImportTest, WithoutADeploymentTheLogIsExportedAndReplayed) {
    recordScan(3);
    ASSERT_THAT(import({}), prints("dive.0.log: 3 pings as receiver.ping\n"));
    for (const char* to : {"scan.npz", "scan.csv", "scan.png", "scan.mcap"}) {
        std::vector<std::string> arguments{"log", "export", "dive.0.log", "--to", to};
        if (std::string(to) != "scan.mcap") arguments.insert(arguments.end(), {"--stream", "receiver.ping"});
        EXPECT_THAT(callInsonify(folder_, arguments), succeeds()) << to;
    }
    const std::string info = callInsonify(folder_, {"log", "info", "dive.0.log", "--metadata"}).out;
    EXPECT_THAT(info, HasSubstr("samples of dive.bin, as its device output them"));
    EXPECT_THAT(info, HasSubstr("A scanning sonar as its recording states it."));
    EXPECT_THAT(callInsonify(folder_, {"replay", "dive.0.log", "wall.yml", "--out", "again"}), succeeds());
}

TEST_F(BeamImportTest, WhatCannotBeComparedIsOneErrorWithTheRemedy) {
    recordScan(2);
    EXPECT_THAT(import(),
                isRefused(HasSubstr("tasks.sonar: has no connection to `settings`, by which each recorded "
                                    "ping gets its bearing; connect the `settings` of a device::Ping360Task")));
    writeFile(folder_ / "wall.yml", getSounder(beam_deployment));
    EXPECT_THAT(import(), isRefused(HasSubstr("tasks.receiver: has no input from a sonar::ScanningSonarTask, whose "
                                              "pings are recorded")));
    EXPECT_FALSE(fs::exists(folder_ / "dive.0.log"));
    EXPECT_THAT(callInsonify(folder_, {"study", "likeness", "wall.yml", "--real", "dive.bin"}),
                isRefused(HasSubstr("dive.bin: --real: is a recording of a Ping360 or a Ping1D, whose pings have one "
                                    "beam; fans and side-scans can be compared")));
    EXPECT_THAT(callInsonify(folder_, {"replay", "dive.bin", "wall.yml"}),
                isRefused(HasSubstr("dive.bin: is a recording of a Ping360 or a Ping1D; `insonify log import` makes a "
                                    "log of it")));
}
