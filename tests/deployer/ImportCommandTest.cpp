// Recordings of an Oculus become logs that are replayed, rendered again and scored.
#include <gmock/gmock.h>

#include "components/device/OculusPing.hpp"
#include "components/device/OculusRecording.hpp"
#include "components/log/Reader.hpp"
#include "tests/deployer/Wall.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using namespace insonify;
using testing::HasSubstr;

namespace {

/** Returns the wall as recorded by an instrument: codes of 16 bits, beams at whole hundredths of a degree. */
std::string wallOfCodes() {
    std::string text = replaced(wall_deployment, "beam_count: 16", "beam_count: 20");
    text = replaced(text, "  log:\n",
                    "  receiver:\n    type: receiver::ReceiverTask\n    properties:\n      output: code\n"
                    "      code: {bits: 16, law: sqrt, full_scale_db: -20}\n  log:\n");
    return replaced(text, "{from: noise.noisy, to: log.noisy, policy: {type: buffer, size: 64}}",
                    "{from: noise.noisy, to: receiver.intensity}\n"
                    "  - {from: receiver.ping, to: log.ping, policy: {type: buffer, size: 64}}");
}

struct ImportCommandTest : testing::Test {
    /** Writes the codes of the wall's receiver to dive.oculus, as the maker's viewer would record them. */
    void record(int pings) const {
        ASSERT_EQ(folder_.run({"--pings", std::to_string(pings)}).code, 0);
        const auto log = log::openLog(folder_ / "out/wall.0.log");
        device::OculusRecorder recorder(folder_ / "dive.oculus", {});
        device::OculusEncoder encoder;
        log->forEach<types::Sonar>("receiver.ping", [&](const types::Sonar& ping, const log::SampleRef&) {
            device::OculusResult result;
            result.fire.header.id = static_cast<uint16_t>(device::OculusId::PingResult);
            result.fire.flags |= device::OculusFire::wide_16;
            result.range_resolution = ping.binStart(1);
            result.speed_of_sound = static_cast<double>(ping.speed_of_sound);
            encoder.encode(ping, result);
            result.settle();
            recorder.write(ping.time.seconds(), toBytes(result));  // speckle depends on the time
        });
    }
    /** A recording of pings of the wall at 20 m and, from the third on, at 15 m. */
    void recordAChange() const {
        record(2);
        const std::string before = readFile(folder_ / "dive.oculus");
        writeFile(folder_ / "wall.yml", replaced(wallOfCodes(), "range: 20", "range: 15"));
        record(4);
        const std::string after = readFile(folder_ / "dive.oculus");
        const size_t header = 48, ping = (after.size() - header) / 4;
        writeFile(folder_ / "wall.yml", wallOfCodes());
        writeFile(folder_ / "dive.oculus", before + after.substr(header + 2 * ping));
    }
    Outcome import(const std::string& recording, const std::string& deployment = "wall.yml") const {
        return callInsonify(folder_, {"log", "import", recording, deployment, "--to", "dive.0.log"});
    }
    json score(const std::string& deployment = "wall.yml") const {
        EXPECT_THAT(
            callInsonify(folder_, {"replay", "dive.0.log", deployment, "--rerender", "--score", "--out", "scored"}),
            succeeds());
        const json all = json::parse(readFile(folder_ / "scored/score.json"));
        for (const json& stream : all["streams"])
            if (stream["stream"] == "receiver.ping") return stream;
        return {};
    }

    const WallFolder folder_{wallOfCodes()};
};

}  // namespace

TEST_F(ImportCommandTest, ARecordingOfRenderedPingsIsRenderedAgain) {
    record(3);
    ASSERT_THAT(import("dive.oculus"), prints(HasSubstr("dive.0.log: 3 pings as receiver.ping")));
    EXPECT_EQ(callInsonify(folder_, {"log", "check", "dive.0.log"}).code, 0);
    const json scored = score();
    EXPECT_EQ(scored["compared"], 3);
    for (const json& ping : scored["pings"]) EXPECT_LT(ping["rel_l2"], 1e-3) << "codes of 16 bits";
}

TEST_F(ImportCommandTest, TheLogHasThePingsTimesAndThePosesOfTheTrajectory) {
    record(3);
    ASSERT_EQ(import("dive.oculus").code, 0);
    const auto log = log::openLog(folder_ / "dive.0.log");
    ASSERT_TRUE(log->find("vehicle.pose") && log->find("receiver.ping"));
    EXPECT_EQ(log->find("vehicle.pose")->count, 3u);
    EXPECT_NEAR(log->find("receiver.ping")->last.seconds() - log->find("receiver.ping")->first.seconds(), 0.2, 1e-5);
    EXPECT_NEAR(log->find("receiver.ping")->first.seconds(), 1, 1e-6);
    log->forEach<types::Sonar>("receiver.ping", [](const types::Sonar& ping, const log::SampleRef&) {
        EXPECT_EQ(ping.beam_count, 20u);
        EXPECT_NEAR(ping.bearings.front().deg(), -28.5, 1e-9) << "starboard first";
        EXPECT_EQ(ping.bin_duration.microseconds, 267);
    });
}

TEST_F(ImportCommandTest, EveryPingIsKeptWhenSettingsChange) {
    recordAChange();
    const Outcome outcome = import("dive.oculus");
    ASSERT_THAT(outcome, prints(HasSubstr("dive.0.log: 4 pings as receiver.ping")));
    EXPECT_THAT(outcome.err, HasSubstr("notice: settings change 1 times; properties.0.log next to the log has them"));
    std::vector<double> ranges;
    log::openLog(folder_ / "dive.0.log")
        ->forEach<types::Sonar>("receiver.ping", [&](const types::Sonar& ping, const log::SampleRef&) {
            ranges.push_back(std::round(ping.binStart(ping.bin_count)));
        });
    EXPECT_THAT(ranges, testing::ElementsAre(20, 20, 15, 15));
    const json scored = score();
    EXPECT_EQ(scored["compared"], 4);
    EXPECT_EQ(scored["other_shape"], 0);
    for (const json& ping : scored["pings"]) EXPECT_LT(ping["rel_l2"], 1e-3) << ping["index"];
}

TEST_F(ImportCommandTest, WithoutADeploymentTheLogHasTheRecordingsData) {
    record(3);
    ASSERT_THAT(callInsonify(folder_, {"log", "import", "dive.oculus", "--to", "alone.0.log"}), succeeds());
    ASSERT_EQ(import("dive.oculus").code, 0);
    const auto alone = log::openLog(folder_ / "alone.0.log"), with = log::openLog(folder_ / "dive.0.log");
    ASSERT_EQ(alone->streams().size(), 1u);
    std::vector<std::vector<float>> bins;
    with->forEach<types::Sonar>("receiver.ping", [&](const auto& ping, const auto&) { bins.push_back(ping.bins); });
    size_t i = 0;
    alone->forEach<types::Sonar>("receiver.ping",
                                 [&](const auto& ping, const auto&) { EXPECT_EQ(ping.bins, bins[i++]); });
    EXPECT_EQ(i, 3u);
}

TEST_F(ImportCommandTest, ARealSideScanBecomesAWaterfallArraysAndTheSameXtfFile) {
    const fs::path recording = test::sharedFile("sonar/xtf/scotsman-iver2.xtf");
    if (!fs::exists(recording)) GTEST_SKIP() << recording << " is missing: no real XTF file is tested";
    const Outcome outcome = callInsonify(folder_, {"log", "import", recording, "--to", "side.0.log"});
    ASSERT_THAT(outcome, prints("side.0.log: 461 pings as receiver.ping\n"));
    EXPECT_THAT(outcome.err, HasSubstr("x = y = 0 of the world is latitude 48.4454500, longitude -68.8279350"));
    const auto log = log::openLog(folder_ / "side.0.log");
    EXPECT_EQ(log->find("sonar.pose")->count, 460u);
    EXPECT_EQ(log->find("altimeter.range")->count, 460u);
    const auto to = [&](const std::string& file) {
        return callInsonify(folder_, {"log", "export", "side.0.log", "--stream", "receiver.ping", "--to", file});
    };
    EXPECT_EQ(to("side.png").out, "side_000000.png\n") << "one waterfall with all lines";
    EXPECT_EQ(to("side.npz").code, 0);
    ASSERT_EQ(to("side.xtf").code, 0);
    ASSERT_EQ(callInsonify(folder_, {"log", "import", "side.xtf", "--to", "again.0.log"}).code, 0);
    std::vector<types::Sonar> first, again;
    log->forEach<types::Sonar>("receiver.ping", [&](const auto& ping, const auto&) { first.push_back(ping); });
    log::openLog(folder_ / "again.0.log")->forEach<types::Sonar>("receiver.ping", [&](const auto& ping, const auto&) {
        again.push_back(ping);
    });
    ASSERT_EQ(again.size(), first.size());
    for (size_t i = 0; i < first.size(); ++i) EXPECT_EQ(again[i].bins, first[i].bins);
}

TEST_F(ImportCommandTest, AJsfFileBecomesALogThatIsCheckedAndExported) {
    const std::string recording = test::sourceFile("tests/fuzz/corpus/jsf/two_pings");
    const Outcome outcome = callInsonify(folder_, {"log", "import", recording, "--to", "side.0.log"});
    ASSERT_THAT(outcome, prints("side.0.log: 2 pings as receiver.ping\n"));
    EXPECT_THAT(outcome.err, HasSubstr("settings change 1 times; each ping has its own range and bins"));
    EXPECT_EQ(callInsonify(folder_, {"log", "check", "side.0.log"}).code, 0);
    const auto to = [&](const std::string& file) {
        return callInsonify(folder_, {"log", "export", "side.0.log", "--stream", "receiver.ping", "--to", file});
    };
    EXPECT_EQ(to("side.png").out, "side_000000.png\nside_000001.png\n") << "one for each range";
    EXPECT_EQ(to("side.xtf").code, 0);
}

TEST_F(ImportCommandTest, RecordingsAndPropertiesOfOtherRunsStay) {
    record(2);
    const std::string recording = readFile(folder_ / "dive.oculus"), own = readFile(folder_ / "out/properties.0.log");
    fs::create_symlink("dive.oculus", folder_ / "same.log");
    EXPECT_THAT(callInsonify(folder_, {"log", "import", "dive.oculus", "--to", "same.log"}).err,
                HasSubstr("same.log: --to: is the recording itself"));
    const auto into = [&](const std::string& log) {
        return callInsonify(folder_, {"log", "import", "dive.oculus", "wall.yml", "--to", log});
    };
    EXPECT_THAT(into("out/dive.0.log").err, HasSubstr("out/properties.0.log: --to: is of another run; give the log"));
    EXPECT_EQ(readFile(folder_ / "dive.oculus"), recording);
    EXPECT_EQ(readFile(folder_ / "out/properties.0.log"), own);
    EXPECT_EQ(into("imported/dive.0.log").code, 0);
    EXPECT_EQ(into("imported/dive.0.log").code, 0) << "the same import again";
    EXPECT_THAT(callInsonify(folder_, {"log", "info", "dive.oculus"}),
                isRefused("dive.oculus: is a recording of an Oculus; `insonify log import` makes a log of it\n"));
    EXPECT_THAT(callInsonify(folder_, {"log", "import", "no.xtf", "--to", "x.0.log"}).err,
                HasSubstr("no.xtf: does not exist; may be a .xtf, .jsf, "));
}

TEST_F(ImportCommandTest, ADamagedXtfFileIsOneErrorAndLeavesNoLog) {
    std::string bytes(1024 + 256, '\0');
    bytes[0] = '\x7B';
    writeFile(folder_ / "line.xtf", bytes);
    EXPECT_THAT(callInsonify(folder_, {"log", "import", "line.xtf", "--to", "line.0.log"}),
                isRefused("line.xtf: byte 1024: is 0x0000; a packet begins with 0xFACE\n"));
    writeFile(folder_ / "line.xtf", bytes.substr(0, 1030));
    EXPECT_THAT(callInsonify(folder_, {"log", "import", "line.xtf", "--to", "line.0.log"}).err,
                HasSubstr("line.xtf: holds no ping of a side-scan; the packet at byte 1024 is cut off"));
    EXPECT_FALSE(fs::exists(folder_ / "line.0.log"));
}

TEST_F(ImportCommandTest, RealPingsAreLoggedReplayedAndScored) {
    const fs::path recording = test::sharedFile("sonar/oculus/three_pings_8bit.raw");
    if (!fs::exists(recording)) GTEST_SKIP() << recording << " is missing: no recording of a device is tested";
    const std::string deployment = test::sourceFile("deploy/hil_oculus.yml");
    const Outcome outcome = import(recording, deployment);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("as recorded: sonar.frequency_khz=2098.88"));
    EXPECT_THAT(outcome.err, HasSubstr("[256 values, -30 to 30]"));
    const json scored = score(deployment);
    EXPECT_EQ(scored["compared"], 3);
    for (const json& ping : scored["pings"]) EXPECT_TRUE(ping["correlation"].is_number());
}

TEST_F(ImportCommandTest, ReportsWhyAFileCannotBeImported) {
    writeFile(folder_ / "empty.raw", "SO");
    EXPECT_THAT(import("empty.raw").err, HasSubstr("empty.raw: holds no ping of an Oculus"));
    EXPECT_THAT(import("missing.raw").err, HasSubstr("missing.raw: does not exist"));
    record(1);
    writeFile(folder_ / "plain.yml", wall_deployment);
    EXPECT_THAT(import("dive.oculus", "plain.yml").err, HasSubstr("has no receiver that outputs codes"));
    EXPECT_THAT(callInsonify(folder_, {"log", "import", "dive.oculus", "wall.yml", "--to", "plain.yml/dive.0.log"}),
                isRefused(HasSubstr("plain.yml: --to: is no folder and cannot be made")));
}
