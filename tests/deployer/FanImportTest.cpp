// Recordings of an ARIS and of a Gemini become logs that are exported, replayed, rendered again and scored.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <cmath>

#include "components/log/Reader.hpp"
#include "components/recordings/ArisFile.hpp"
#include "tests/deployer/Wall.hpp"
#include "tests/support/ArisRecording.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/GlfRecording.hpp"
#include "types/samples/Pose.hpp"
#include "types/samples/Sonar.hpp"

using namespace insonify::deployer;
using namespace insonify;
using testing::HasSubstr;

namespace {

constexpr uint32_t first_bin = 20, bins = 260;  // of 50 us one way: 7.5 cm

/** Returns the wall as recorded by an instrument with these beams: codes of 8 bits, 80 dB, from 1.5 m on. */
std::string wallWith(const std::vector<double>& bearings_deg) {
    std::string text = replaced(wall_deployment, "range: 20", "range: 19.5");
    text = replaced(text, "beam_count: 16", fmt::format("bearings_deg: {}", bearings_deg));
    text = replaced(text, "bin_count: 50", fmt::format("bin_count: {}\n      beam_width_deg: 1", bins));
    text = replaced(text, "      field_of_view_deg: 60\n", "      speed_of_sound: 1500\n      range_rounding: exact\n");
    text = replaced(text, "  log:\n",
                    "  fan: {type: output::FanImageTask, properties: {file: fan_%06d.png, scale: code}}\n"
                    "  receiver:\n    type: receiver::ReceiverTask\n    properties:\n      output: code\n"
                    "      blanking: {range_min: 1.5}\n"
                    "      code: {bits: 8, law: log, full_scale_db: -20, dynamic_range_db: 80}\n  log:\n");
    return replaced(text, "{from: noise.noisy, to: log.noisy, policy: {type: buffer, size: 64}}",
                    "{from: noise.noisy, to: receiver.intensity}\n"
                    "  - {from: receiver.ping, to: fan.ping}\n"
                    "  - {from: receiver.ping, to: log.ping, policy: {type: buffer, size: 64}}");
}

std::vector<double> arisBearingsDeg() {
    const auto table = recordings::arisBearings(recordings::ArisModel::Aris1800, 48, false);
    return {table.begin(), table.end()};
}

/** Uneven bearings of a Gemini, from port. */
std::vector<double> geminiBearingsDeg() {
    std::vector<double> bearings;
    for (int i = 0; i < 40; ++i) bearings.push_back(30 - 1.5 * i + 0.3 * std::sin(i));
    return bearings;
}

struct FanImportTest : testing::Test {
    /** The pings of a run of the wall. */
    std::vector<types::Sonar> getPings(const std::string& deployment, int count) const {
        writeFile(folder_ / "wall.yml", deployment);
        EXPECT_EQ(folder_.run({"--pings", std::to_string(count)}).code, 0);
        std::vector<types::Sonar> pings;
        log::openLog(folder_ / "out/wall.0.log")
            ->forEach<types::Sonar>("receiver.ping", [&](const auto& ping, const auto&) { pings.push_back(ping); });
        return pings;
    }
    /** Returns the samples from the window's start, in the order of a file. @param order of the beams */
    static test::RecordedBytes getSamples(const types::Sonar& ping, uint32_t first) {
        test::RecordedBytes samples;
        for (uint32_t bin = first; bin < ping.bin_count; ++bin)
            for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
                samples.push_back(static_cast<char>(std::lround(ping.bins[beam * ping.bin_count + bin])));
        return samples;
    }
    static test::ArisFrame arisFrame(const types::Sonar& ping) {
        test::ArisFrame frame{.model = 0, .ping_mode = 1, .is_high = false};
        frame.period_us = 100;
        frame.delay_us = 2000;
        frame.sound_speed = 1500;
        frame.time_us = static_cast<uint64_t>(ping.time.microseconds);
        frame.samples = getSamples(ping, first_bin);
        return frame;
    }
    void recordAris(int count) const {
        std::vector<test::ArisFrame> frames;
        for (const auto& ping : getPings(wallWith(arisBearingsDeg()), count)) frames.push_back(arisFrame(ping));
        writeBytes(folder_ / "dive.aris", test::arisFile(frames));
    }
    void recordGemini(int count) const {
        constexpr int64_t from_1980 = 315'532'800;  // [s]
        std::vector<test::RecordedBytes> records;
        for (const auto& ping : getPings(wallWith(geminiBearingsDeg()), count)) {
            test::GlfImage image{.start_range = first_bin, .end_range = bins, .rate_hz = 10'000};
            image.time_s = ping.time.seconds() + 1'500'000'000 - from_1980;
            for (const types::Angle bearing : ping.bearings) image.bearings.push_back(bearing.rad);
            image.packed = getSamples(ping, first_bin);
            records.push_back(test::glfRecord(image));
        }
        writeBytes(folder_ / "dive.glf", test::glfFile(records));
    }
    Outcome import(const std::string& recording, const std::string& deployment = "wall.yml") const {
        std::vector<std::string> arguments{"log", "import", recording, "--to", "dive.0.log"};
        if (!deployment.empty()) arguments.insert(arguments.begin() + 3, deployment);
        return callInsonify(folder_, arguments);
    }
    json score() const {
        EXPECT_THAT(
            callInsonify(folder_, {"replay", "dive.0.log", "wall.yml", "--rerender", "--score", "--out", "scored"}),
            succeeds());
        const json all = json::parse(readFile(folder_ / "scored/score.json"));
        for (const json& stream : all["streams"])
            if (stream["stream"] == "receiver.ping") return stream;
        return {};
    }

    const WallFolder folder_{wallWith(arisBearingsDeg())};
};

}  // namespace

TEST_F(FanImportTest, AnArisFileOfRenderedPingsIsRenderedAgain) {
    recordAris(3);
    const Outcome outcome = import("dive.aris");
    ASSERT_THAT(outcome, prints("dive.0.log: 3 pings as receiver.ping\n"));
    EXPECT_THAT(outcome.err, HasSubstr("as recorded: receiver.blanking={range_min: 1.5}"));
    EXPECT_EQ(callInsonify(folder_, {"log", "check", "dive.0.log"}).code, 0);
    const json scored = score();
    EXPECT_EQ(scored["compared"], 3);
    EXPECT_EQ(scored["other_shape"], 0);
    for (const json& ping : scored["pings"]) EXPECT_LT(ping["rel_l2"], 1e-3) << ping.dump();
}

TEST_F(FanImportTest, AGlfFileHasTheRenderedPings) {
    recordGemini(3);
    ASSERT_THAT(import("dive.glf"), succeeds());
    std::vector<types::Sonar> rendered, imported;
    const auto read = [&](const char* log, std::vector<types::Sonar>& pings) {
        log::openLog(folder_ / log)->forEach<types::Sonar>("receiver.ping", [&](const auto& ping, const auto&) {
            pings.push_back(ping);
        });
    };
    read("out/wall.0.log", rendered);
    read("dive.0.log", imported);
    ASSERT_EQ(imported.size(), 3u);
    for (size_t i = 0; i < 3; ++i) {
        const types::Sonar &before = rendered[i], &after = imported[i];
        ASSERT_EQ(after.bins.size(), before.bins.size());
        EXPECT_DOUBLE_EQ(after.binStart(after.bin_count), before.binStart(before.bin_count));
        for (uint32_t beam = 0; beam < before.beam_count; ++beam) {  // from port in the file, from starboard in the log
            const uint32_t other = before.beam_count - 1 - beam;
            EXPECT_NEAR(after.bearings[other].rad, before.bearings[beam].rad, 1e-12);
            for (uint32_t bin = 0; bin < bins; ++bin)
                ASSERT_EQ(after.bins[other * bins + bin], before.bins[beam * bins + bin]) << beam << " " << bin;
        }
    }
    const json scored = score();  // speckle depends on the time, which differs
    EXPECT_EQ(scored["compared"], 3);
    for (const json& ping : scored["pings"]) EXPECT_GT(ping["correlation"], 0.5) << ping.dump();
}

TEST_F(FanImportTest, WithoutADeploymentTheLogIsExportedAndReplayed) {
    recordAris(2);
    ASSERT_THAT(import("dive.aris", ""), succeeds());
    const auto to = [&](const std::string& file) {
        return callInsonify(folder_, {"log", "export", "dive.0.log", "--stream", "receiver.ping", "--to", file});
    };
    EXPECT_EQ(to("fan.png").out, "fan_000000.png\nfan_000001.png\n");
    EXPECT_EQ(to("fan.npz").code, 0);
    EXPECT_EQ(to("fan.csv").code, 0);
    const std::string info = callInsonify(folder_, {"log", "info", "dive.0.log", "--metadata"}).out;
    EXPECT_THAT(info, HasSubstr("samples of dive.aris, as its device output them"));
    EXPECT_THAT(info, HasSubstr("\"dynamic_range_db\": 80"));
    EXPECT_THAT(callInsonify(folder_, {"replay", "dive.0.log", "wall.yml", "--out", "again"}), succeeds());
    EXPECT_TRUE(fs::exists(folder_ / "again/fan_000001.png"));
}

TEST_F(FanImportTest, PosesOfTheRecordingBecomeThoseOfTheVehicleAndTheSonar) {
    types::Sonar ping;
    ping.time = {1'700'000'000'000'000};
    ping.resize(bins, 48);
    ping.bins.assign(ping.bins.size(), 1);
    test::ArisFrame frame = arisFrame(ping);
    frame.heading = 30;
    frame.depth = 2;
    frame.altitude = 4;
    writeBytes(folder_ / "dive.aris", test::arisFile({frame}));
    ASSERT_EQ(import("dive.aris").code, 0);
    const auto log = log::openLog(folder_ / "dive.0.log");
    for (const char* stream : {"vehicle.pose", "sonar.pose"}) {
        ASSERT_TRUE(log->find(stream)) << stream;
        log->forEach<types::Pose>(stream, [](const types::Pose& pose, const auto&) {
            EXPECT_EQ(pose.position, glm::dvec3(0, 0, -2));
            EXPECT_NEAR((pose.orientation * glm::dvec3(1, 0, 0)).y, -0.5, 1e-6) << "30 deg to starboard of north";
        });
    }
    EXPECT_EQ(log->find("altimeter.range")->count, 1u);
}

TEST_F(FanImportTest, ADamagedFileIsOneErrorAndLeavesNoLog) {
    test::RecordedBytes bytes = test::arisHeader();
    writeBytes(folder_ / "empty.aris", bytes);
    EXPECT_EQ(import("empty.aris").err, "empty.aris: holds no ping of an ARIS\n");
    bytes.resize(3000);
    writeBytes(folder_ / "zero.aris", bytes);
    EXPECT_THAT(import("zero.aris"),
                isRefused("zero.aris: byte 1036: is 0x00000000; the header of a frame has 0x05464444 here\n"));
    EXPECT_FALSE(fs::exists(folder_ / "dive.0.log"));
}
