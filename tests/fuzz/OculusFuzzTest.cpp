// Messages of an Oculus, in captures and in its maker's log files, and messages of drivers to it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "components/device/OculusPing.hpp"
#include "components/device/OculusRecording.hpp"
#include "components/device/oculus/OculusEmulator.hpp"
#include "tests/support/Fuzz.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::fuzz {
namespace {

void expectSound(const device::OculusPing& ping) {
    EXPECT_EQ(ping.codes.size(), size_t{ping.beamCount()} * ping.bin_count);
    EXPECT_TRUE(ping.row_gains.empty() || ping.row_gains.size() == ping.bin_count);
    EXPECT_TRUE(std::ranges::all_of(ping.codes, [&](uint32_t code) { return code <= ping.maxCode(); }));
    EXPECT_TRUE(std::isfinite(ping.frequency_hz) && ping.frequency_hz >= 0) << ping.frequency_hz;
    EXPECT_TRUE(std::isfinite(ping.speed_of_sound) && ping.speed_of_sound >= 0) << ping.speed_of_sound;
    EXPECT_GT(ping.range_resolution, 0);
    EXPECT_GT(ping.gamma, 0);
}

void readOculus(const Input& input) try {
    device::OculusReader reader(input.file());
    while (const auto read = reader.next()) {
        EXPECT_NO_THROW(read->ping.validate());
        EXPECT_GT(read->max_code, 0);
    }
    for (const std::string& notice : reader.notices()) expectOurWords(notice);
} catch (const types::ConfigError& error) {
    expectOurWords(error.what());
}

/** Expects that every ping of a stream is written as it was read. */
void frame(const Input& input) {
    device::OculusFramer framer;
    framer.add(input.octets());
    for (device::Bytes message = framer.next(); !message.empty(); message = framer.next()) {
        EXPECT_TRUE(device::oculusHeader(message));
        if (const auto ping = device::oculusResult(message)) {
            EXPECT_EQ(toBytes(*ping), message);
        }
        if (const auto fire = device::oculusFire(message)) {
            EXPECT_EQ(toBytes(*fire).size(), fire->size());
        }
        device::oculusUserConfig(message);
        device::oculusStatus(message);
    }
}

/** Simulates a sonar of two beams and two bins that answers any request of the driver. */
void driveOculus(const Input& input) {
    types::Time now{1'000'000};
    device::OculusEmulator emulator({}, now);
    emulator.opened(1);
    const auto bytes = input.octets();
    for (size_t at = 0; at < bytes.size(); at += 64) {
        emulator.received(1, bytes.subspan(at, std::min<size_t>(64, bytes.size() - at)));
        now = now + types::Time{1'000'000};
        const auto asked = emulator.tick(now).ask;
        if (!asked) continue;
        EXPECT_TRUE(asked->range >= 0.1 && asked->range <= 120) << asked->range;
        EXPECT_TRUE(asked->bin_count >= 1 && asked->bin_count <= 1000) << asked->bin_count;
        EXPECT_TRUE(asked->gain_db >= -20 && asked->gain_db <= 20) << asked->gain_db;
        types::Sonar ping;
        ping.time = now;
        ping.resize(2, 2);
        ping.setRegularBearings({0}, {0.1});
        ping.bins = {0, 1, 300, 65535};
        EXPECT_TRUE(device::oculusResult(emulator.ping(ping)));
    }
}

void play(const Input& input) try {
    frame(input);
    device::OculusPings recording(input.file());
    while (const auto recorded = recording.next()) expectSound(device::makePing(recorded->ping));
    if (!device::OculusRecording::isOne(input.file())) return;
    device::OculusRecording items(input.file());
    while (const auto item = items.next()) item->content();
} catch (const types::ConfigError& error) {
    expectOurWords(error.what());
}

TEST(OculusFuzzTest, ADriverThatSendsAnythingGetsPingsOrNothing) {
    push({"oculus_driver",
          "driver.raw",
          {std::string("\x53\x4f\0\0\0\0\x15\0\1\0", 10), std::string("\x25\0\0\0", 4), std::string("\x49\0\0\0", 4),
           std::string("\x53\x4f\0\0\0\0\x55\0\0\0", 10), std::string("\xff\xff\xff\xff\xff\xff\xff\x7f", 8)},
          driveOculus});
}

TEST(OculusFuzzTest, EveryRecordingIsPingsOrAnError) {
    push({"oculus_recording",
          "dive.oculus",
          {std::string("\x44\x33\x22\x11\x30\0\0\0", 8), std::string("\xdd\xcc\xbb\xaa\x28\0\0\0", 8),
           std::string("\x53\x4f\0\0\0\0\x23\0\1\0", 10), std::string("\x78\x9c", 2)},
          play});
}

TEST(OculusFuzzTest, EveryCaptureIsPingsOrAnError) {
    push({"oculus",
          "capture.raw",
          {std::string("\x53\x4f", 2), std::string("\x23\0\1\0", 4), std::string("\x23\0\2\0", 4),
           std::string("\x53\x4f\0\0\0\0\x23\0\1\0", 10)},
          readOculus});
}

}  // namespace
}  // namespace insonify::fuzz
