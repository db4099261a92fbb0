// Recordings of an Oculus become logs, which are replayed, rendered again and scored.
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

/** The wall as an instrument records it: codes of 16 bits, beams at whole hundredths of a degree. */
std::string codedWall() {
    std::string text = replaced(wall_deployment, "beam_count: 16", "beam_count: 20");
    text = replaced(text, "  log:\n",
                    "  receiver:\n    type: receiver::ReceiverTask\n    properties:\n      output: code\n"
                    "      code: {bits: 16, law: sqrt, full_scale_db: -20}\n  log:\n");
    return replaced(text, "{from: noise.noisy, to: log.noisy, policy: {type: buffer, size: 64}}",
                    "{from: noise.noisy, to: receiver.intensity}\n"
                    "  - {from: receiver.ping, to: log.ping, policy: {type: buffer, size: 64}}");
}

class ImportCommandTest : public testing::Test {
protected:
    /** What the wall's receiver gave out, as the maker's viewer would have recorded it: in dive.oculus. */
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
            recorder.write(ping.time.seconds(), bytesOf(result));  // speckle goes by the time
        });
    }
    Outcome import(const std::string& recording, const std::string& deployment = "wall.yml") const {
        return callInsonify(folder_, {"log", "import", recording, deployment, "--to", "dive.0.log"});
    }
    json score(const std::string& deployment = "wall.yml") const {
        const Outcome outcome =
            callInsonify(folder_, {"replay", "dive.0.log", deployment, "--rerender", "--score", "--out", "scored"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        const json all = json::parse(readFile(folder_ / "scored/score.json"));
        for (const json& stream : all["streams"])
            if (stream["stream"] == "receiver.ping") return stream;
        return {};
    }

    const WallFolder folder_{codedWall()};
};

}  // namespace

TEST_F(ImportCommandTest, ARecordingOfWhatWasRenderedIsRenderedAgain) {
    record(3);
    const Outcome outcome = import("dive.oculus");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("dive.0.log: 3 pings as receiver.ping"));
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

TEST_F(ImportCommandTest, RealPingsAreLoggedReplayedAndScored) {
    const fs::path recording = test::sharedFile("sonar/oculus/three_pings_8bit.raw");
    if (!fs::exists(recording)) GTEST_SKIP() << recording << " is not there: no recording of a device is tested";
    const std::string deployment = test::sourceFile("deploy/hil_oculus.yml");
    const Outcome outcome = import(recording, deployment);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("as recorded: sonar.frequency_khz=2098.88"));
    const json scored = score(deployment);
    EXPECT_EQ(scored["compared"], 3);
    for (const json& ping : scored["pings"]) EXPECT_TRUE(ping["correlation"].is_number());
}

TEST_F(ImportCommandTest, WhatCannotBeImportedIsToldWithTheReason) {
    writeFile(folder_ / "empty.raw", "SO");
    EXPECT_THAT(import("empty.raw").err, HasSubstr("empty.raw: holds no ping of an Oculus"));
    EXPECT_THAT(import("missing.raw").err, HasSubstr("missing.raw: cannot be read"));
    record(1);
    writeFile(folder_ / "plain.yml", wall_deployment);
    EXPECT_THAT(import("dive.oculus", "plain.yml").err, HasSubstr("has no receiver that gives out codes"));
    const Outcome outcome =
        callInsonify(folder_, {"log", "import", "dive.oculus", "wall.yml", "--to", "nowhere/dive.0.log"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("nowhere"));
}
