// Frames as PyPI's pymavlink 2.4.50 packs them, and their errors.
#include <gmock/gmock.h>

#include "components/mavlink/Body.hpp"
#include "components/mavlink/Frame.hpp"
#include "tests/mavlink/Packed.hpp"

namespace insonify::mavlink {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

Datagram read(const Bytes& bytes) { return readDatagram(bytes, received_kinds); }

template <class Message>
Message only(const Bytes& bytes) {
    const Datagram datagram = read(bytes);
    EXPECT_EQ(datagram.diagnostic, "");
    EXPECT_THAT(datagram.frames, SizeIs(1));
    const auto message = datagram.frames.empty() ? std::nullopt : makeMessage<Message>(datagram.frames[0]);
    EXPECT_TRUE(message);
    return message.value_or(Message{});
}

TEST(FrameTest, AnAttitudeOfVersionOneTwoAndSignedIsTheSame) {
    for (const Bytes& packed : {attitude_1, attitude_2, attitude_signed}) {
        const auto attitude = only<AttitudeQuaternion>(packed);
        EXPECT_EQ(attitude.time_boot_ms, 123456u);
        EXPECT_EQ(attitude.w, 0.5f);
        EXPECT_EQ(attitude.x, 0.5f);
        EXPECT_EQ(attitude.y, -0.5f);
        EXPECT_EQ(attitude.z, 0.5f);
        EXPECT_EQ(attitude.roll_speed, 0.25f);
        EXPECT_EQ(attitude.pitch_speed, -0.5f);
        EXPECT_EQ(attitude.yaw_speed, 1.0f);
    }
    const Frame frame = read(attitude_1).frames.at(0);
    EXPECT_EQ(frame.version, 1);
    EXPECT_EQ(frame.sequence, 7);
    EXPECT_EQ(frame.system, 1);
    EXPECT_EQ(frame.component, 1);
}

TEST(FrameTest, RestoresTheTrailingZerosThatVersionTwoOmits) {
    const auto position = only<LocalPositionNed>(position_2);
    EXPECT_EQ(position.x, 1.5f);
    EXPECT_EQ(position.y, -2.5f);
    EXPECT_EQ(position.z, 3.5f);
    EXPECT_EQ(position.vx, 0.5f);
    EXPECT_EQ(position.vz, 0.0f);
    const auto nowhere = only<LocalPositionNed>(bytesOfHex("fd0100000701012000000091ea"));
    EXPECT_EQ(nowhere.time_boot_ms, 0u);
    EXPECT_EQ(nowhere.vz, 0.0f);
}

TEST(FrameTest, AVisionEstimateIsReadWithoutItsCovariance) {
    const auto estimate = only<VisionPositionEstimate>(vision_2);
    EXPECT_EQ(estimate.usec, 1700000000123456u);
    EXPECT_EQ(estimate.z, 3.5f);
    EXPECT_EQ(estimate.roll, 0.125f);
    EXPECT_EQ(estimate.pitch, 0.25f);
    EXPECT_EQ(estimate.yaw, 0.5f);
}

TEST(FrameTest, SendsTheBytesOfPymavlink) {
    const AttitudeQuaternion attitude{123456, 0.5f, 0.5f, -0.5f, 0.5f, 0.25f, -0.5f, 1.0f};
    EXPECT_EQ(getFrame(attitude, 1, 1, 7, 1).bytes(AttitudeQuaternion::kind.crc_extra), attitude_1);
    EXPECT_EQ(getFrame(attitude, 1, 1, 7, 2).bytes(AttitudeQuaternion::kind.crc_extra), attitude_2);
    CommandLong command{.command = CommandLong::set_message_interval, .target_system = 1, .target_component = 1};
    command.parameters[0] = 31;
    command.parameters[1] = 50000;
    EXPECT_EQ(getFrame(command, 255, 190).bytes(CommandLong::kind.crc_extra),
              bytesOfHex("fd20000000ffbe4c00000000f84100504347000000000000000000000000000000000000"
                         "0000ff010101dc73"));
}

TEST(FrameTest, IgnoresAnUnknownMessageSilently) {
    const Datagram datagram = read(joined({attitude_euler_2, attitude_2, heartbeat_2}));
    EXPECT_EQ(datagram.diagnostic, "");
    ASSERT_THAT(datagram.frames, SizeIs(2));
    EXPECT_EQ(datagram.frames[0].message, AttitudeQuaternion::kind.message);
    EXPECT_EQ(datagram.frames[1].message, Heartbeat::kind.message);
}

TEST(FrameTest, ReportsEveryTruncatedFrameAndReadsNothing) {
    for (const Bytes& packed : {attitude_1, attitude_2, attitude_signed})
        for (size_t size = 1; size < packed.size(); ++size) {
            const Datagram datagram = read(Bytes(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size)));
            EXPECT_THAT(datagram.frames, IsEmpty()) << size;
            EXPECT_EQ(datagram.diagnostic, "a frame that is cut off") << size;
        }
    EXPECT_THAT(read({}).frames, IsEmpty());
    EXPECT_EQ(read({}).diagnostic, "");
}

TEST(FrameTest, RejectsAFrameWithAnyWrongByte) {
    for (const Bytes& packed : {attitude_1, attitude_2})
        for (size_t at = 0; at < packed.size(); ++at) {
            Bytes wrong = packed;
            wrong[at] ^= 0x10;
            const Datagram datagram = read(wrong);
            EXPECT_THAT(datagram.frames, IsEmpty()) << at;
        }
    Bytes wrong = attitude_2;
    wrong.back() ^= 1;
    EXPECT_EQ(read(wrong).diagnostic, "a frame with a wrong checksum");
}

TEST(FrameTest, FindsAFrameBehindDamageAndNoise) {
    Bytes cut(attitude_2.begin(), attitude_2.end() - 5);
    const Datagram datagram = read(joined({{1, 2, 0xfd, 3}, cut, position_2, {0xfe}, attitude_1, {9}}));
    ASSERT_THAT(datagram.frames, SizeIs(2));
    EXPECT_EQ(datagram.frames[0].message, LocalPositionNed::kind.message);
    EXPECT_EQ(datagram.frames[1].version, 1);
    EXPECT_EQ(datagram.diagnostic, "bytes that are no frame");
}

TEST(FrameTest, AFrameOfVersionOneHasTheLengthOfItsMessage) {
    for (const int change : {-4, 4}) {
        Frame frame = read(attitude_1).frames.at(0);
        frame.payload.resize(static_cast<size_t>(static_cast<int>(frame.payload.size()) + change));
        const Datagram datagram = read(frame.bytes(AttitudeQuaternion::kind.crc_extra));
        EXPECT_THAT(datagram.frames, IsEmpty());
        EXPECT_EQ(datagram.diagnostic, "a frame with a wrong length for its message");
    }
}

TEST(FrameTest, IgnoresExtensionFields) {
    Frame frame = read(attitude_2).frames.at(0);
    frame.payload.resize(48, 1);  // a quaternion for displays
    EXPECT_EQ(only<AttitudeQuaternion>(frame.bytes(AttitudeQuaternion::kind.crc_extra)).yaw_speed, 1.0f);
}

TEST(FrameTest, RejectsAFrameWithUnknownIncompatibilityFlags) {
    Bytes strange = attitude_2;
    strange[2] = 2;
    const Datagram datagram = read(joined({strange, position_2}));
    EXPECT_THAT(datagram.frames, SizeIs(1));
    EXPECT_EQ(datagram.diagnostic, "a frame with unknown flags");
}

}  // namespace
}  // namespace insonify::mavlink
