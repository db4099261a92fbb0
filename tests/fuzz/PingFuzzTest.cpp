// Input of a device of the ping protocol, from drivers and from noisy lines, and its answers.
#include <gtest/gtest.h>

#include <algorithm>

#include "components/device/ping/Ping1dEmulator.hpp"
#include "components/device/ping/Ping360Emulator.hpp"
#include "tests/support/Fuzz.hpp"

namespace insonify::fuzz {
namespace {

using device::Bytes;

/** Expects that a found frame was in the input, byte for byte. */
void expectThere(const device::PingFrame& frame, std::span<const uint8_t> bytes) {
    const Bytes again = frame.bytes();
    EXPECT_FALSE(std::ranges::search(bytes, again).empty());
}

template <class... Messages>
void readAs(const device::PingFrame& frame) {
    const auto is_as_before = [&]<class Message>(const std::optional<Message>& message) {
        if (!message) return;
        const Bytes bytes = device::pingBytes(*message, frame.source, frame.destination);
        EXPECT_LE(bytes.size(), frame.bytes().size());
    };
    (is_as_before(device::pingMessage<Messages>(frame)), ...);
}

void readFrames(std::span<const uint8_t> bytes) {
    device::PingFrameReader reader(4096);
    for (size_t at = 0; at < bytes.size(); at += 5) {
        reader.add(bytes.subspan(at, std::min<size_t>(5, bytes.size() - at)));
        EXPECT_LE(reader.waiting(), 4096 + 15u);
        while (const auto frame = reader.next()) {
            expectThere(*frame, bytes);
            readAs<device::Ping360DeviceData, device::Ping360AutoDeviceData, device::Ping1dProfile, device::PingNack,
                   device::PingText, device::PingDeviceInformation, device::Ping1dDistance>(*frame);
        }
    }
}

/** Expects that the device requests possible pings only, and sends only frames. */
void expectSound(device::PingDevice& emulator, types::Time now) {
    for (const device::PingOutgoing& out : emulator.consumeOutgoing())
        EXPECT_EQ(device::pingFrames(out.bytes, 4096).size(), 1u);
    const auto asked = emulator.consumeRequest();
    if (!asked) return;
    EXPECT_GT(asked->range, 0);
    EXPECT_LE(asked->range, 1e4);
    EXPECT_GT(asked->bin_count, 0u);
    EXPECT_LE(asked->bin_count, 20'000u);
    const auto ping = std::make_shared<types::Sonar>();
    ping->time = now;
    ping->resize(asked->bin_count, 1);
    std::ranges::fill(ping->bins, 7.0f);
    emulator.setPing(ping, now);
}

void drive(device::PingDevice&& emulator, std::span<const uint8_t> bytes) {
    types::Time now = types::Time::fromSeconds(1e9);
    for (size_t at = 0; at < bytes.size(); at += 16) {
        const auto piece = bytes.subspan(at, std::min<size_t>(16, bytes.size() - at));
        emulator.receive(at % 3, piece, at % 2 == 0, now);
        expectSound(emulator, now);
        now = now + types::Time::fromSeconds(0.05);
        emulator.tick(now);
        expectSound(emulator, now);
    }
    for (int i = 0; i < 100 && emulator.wakeAt(); ++i) {
        now = std::max(now, *emulator.wakeAt());
        emulator.tick(now);
        expectSound(emulator, now);
    }
}

void enterPing(const Input& input) {
    readFrames(input.octets());
    drive(device::Ping360Emulator({}), input.octets());
    drive(device::Ping1dEmulator({}), input.octets());
}

std::string frameWords(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

TEST(PingFuzzTest, EveryLineIsFramesOrNoise) {
    const device::Ping360Acoustics acoustics{0, 32, 80, 740, 1024};
    push({"ping",
          "line.raw",
          {"BR", frameWords(device::pingBytes(device::PingGeneralRequest{5})),
           frameWords(device::pingBytes(device::PingGeneralRequest{1300})),
           frameWords(device::pingBytes(device::Ping360Transducer{1, 0, acoustics, 1, 0})),
           frameWords(device::pingBytes(device::Ping360AutoTransmit{1, acoustics, {}})),
           frameWords(device::pingBytes(device::Ping360MotorOff{})),
           frameWords(device::pingBytes(device::Ping1dSetRange{0, 1000})),
           frameWords(device::pingBytes(device::Ping1dContinuousStart{1300}))},
          enterPing});
}

}  // namespace
}  // namespace insonify::fuzz
