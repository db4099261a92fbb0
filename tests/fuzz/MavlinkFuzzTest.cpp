// Datagrams in which vehicles send their poses.
#include <gtest/gtest.h>

#include <algorithm>

#include "components/mavlink/Body.hpp"
#include "tests/support/Fuzz.hpp"

namespace insonify::fuzz {
namespace {

using mavlink::Bytes;
using types::Time;

/** Expects that the checksum of a found frame is correct, in either version. */
void expectSound(const mavlink::Frame& frame) {
    const auto kind = std::ranges::find(mavlink::received_kinds, frame.message, &mavlink::Kind::message);
    ASSERT_NE(kind, mavlink::received_kinds.end());
    const auto again = mavlink::readDatagram(frame.bytes(kind->crc_extra), mavlink::received_kinds);
    ASSERT_EQ(again.frames.size(), 1u);
    EXPECT_EQ(again.frames[0].message, frame.message);
    EXPECT_EQ(again.frames[0].system, frame.system);
}

void enterMavlink(const Input& input) {
    const auto bytes = input.octets();
    mavlink::Body bodies[] = {{{}, {0, 0, 0}}, {{.source = mavlink::Source::Vision}, {0, 0, 0}}};
    Time now = Time::fromSeconds(1e9);
    for (size_t at = 0; at < bytes.size(); at += 400) {
        const auto datagram =
            mavlink::readDatagram(bytes.subspan(at, std::min<size_t>(400, bytes.size() - at)), mavlink::received_kinds);
        for (const mavlink::Frame& frame : datagram.frames) {
            expectSound(frame);
            for (mavlink::Body& body : bodies) {
                if (!body.wants(frame.message)) continue;
                const auto taken = body.take(frame, 1, now);
                if (!taken.pose) continue;
                EXPECT_TRUE(types::isUsable(*taken.pose));
                EXPECT_LE(taken.pose->time, now);
            }
            now = now + Time::fromSeconds(0.01);
        }
    }
}

std::string frameText(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

template <class Message>
std::string packed(const Message& message, int version) {
    return frameText(mavlink::getFrame(message, 1, 1, 0, version).bytes(Message::kind.crc_extra));
}

TEST(MavlinkFuzzTest, EveryDatagramIsPosesOrNone) {
    push({"mavlink",
          "datagram.raw",
          {"\xfd", "\xfe", packed(mavlink::AttitudeQuaternion{.time_boot_ms = 5000}, 2),
           packed(mavlink::LocalPositionNed{.time_boot_ms = 5000, .x = 1}, 2),
           packed(mavlink::LocalPositionNed{.time_boot_ms = 5000, .x = 1}, 1),
           packed(mavlink::VisionPositionEstimate{.usec = 77}, 2), packed(mavlink::Heartbeat{}, 1)},
          enterMavlink});
}

}  // namespace
}  // namespace insonify::fuzz
