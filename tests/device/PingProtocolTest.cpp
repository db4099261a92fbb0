#include <gmock/gmock.h>

#include <random>

#include "components/device/ping/Ping1dEmulator.hpp"
#include "components/device/ping/Ping360Emulator.hpp"
#include "components/device/ping/PingProtocol.hpp"
#include "tests/device/ByteStrings.hpp"

namespace insonify::device {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr size_t maximum = 2048;

std::vector<uint16_t> messagesIn(PingFrameReader& reader) {
    std::vector<uint16_t> found;
    while (const auto frame = reader.next()) found.push_back(frame->message);
    return found;
}

std::vector<uint16_t> messagesIn(const Bytes& bytes) {
    PingFrameReader reader(maximum);
    reader.add(bytes);
    return messagesIn(reader);
}

/** Returns the message read from a written message. */
template <class Message>
Message there(const Message& message) {
    const auto frames = pingFrames(pingBytes(message, 2, 7), maximum);
    EXPECT_EQ(frames.size(), 1u);
    EXPECT_EQ(frames.at(0).source, 2);
    EXPECT_EQ(frames.at(0).destination, 7);
    const auto read = pingMessage<Message>(frames.at(0));
    EXPECT_TRUE(read.has_value()) << Message::message;
    return read.value_or(Message{});
}

TEST(PingProtocolTest, ARequestHasTheKnownBytes) {
    EXPECT_THAT(pingBytes(PingGeneralRequest{5}), ElementsAre(0x42, 0x52, 2, 0, 6, 0, 0, 0, 5, 0, 0xa1, 0));
}

TEST(PingProtocolTest, AProfileHasTheKnownBytes) {
    const Bytes known = {0x42, 0x52, 0x24, 0, 0x14, 5,    56, 45, 0xe8, 3,    0, 0, 93,   0, 0x3f, 8,
                         0x1c, 0x2b, 0xa6, 2, 0xa0, 0x0f, 0,  0,  0xb8, 0x88, 0, 0, 4,    0, 0,    0,
                         10,   0,    0,    1, 2,    3,    4,  5,  6,    7,    8, 9, 0xde, 5};
    const auto profile = pingMessage<Ping1dProfile>(pingFrames(known, maximum).at(0));
    ASSERT_TRUE(profile);
    EXPECT_EQ(profile->measurement.distance, 1000u);
    EXPECT_EQ(profile->measurement.confidence, 93);
    EXPECT_EQ(profile->measurement.transmit_duration, 2111);
    EXPECT_EQ(profile->measurement.ping_number, 44444444u);
    EXPECT_EQ(profile->measurement.start, 4000u);
    EXPECT_EQ(profile->measurement.length, 35000u);
    EXPECT_EQ(profile->measurement.gain, 4u);
    EXPECT_THAT(profile->data, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9));
    EXPECT_EQ(pingBytes(*profile, 56, 45), known);
}

TEST(PingProtocolTest, MessagesHaveTheSizesOfTheirDefinitions) {
    const auto payload = [](const Bytes& bytes) { return bytes.size() - 10; };
    EXPECT_EQ(payload(pingBytes(Ping360Transducer{})), 14u);
    EXPECT_EQ(payload(pingBytes(Ping360AutoTransmit{})), 16u);
    EXPECT_EQ(payload(pingBytes(Ping360DeviceData{})), 14u);
    EXPECT_EQ(payload(pingBytes(Ping360AutoDeviceData{})), 20u);
    EXPECT_EQ(payload(pingBytes(Ping360Reset{})), 2u);
    EXPECT_EQ(payload(pingBytes(Ping360SetDeviceId{})), 2u);
    EXPECT_EQ(payload(pingBytes(Ping360MotorOff{})), 0u);
    EXPECT_EQ(payload(pingBytes(PingDeviceInformation{})), 6u);
    EXPECT_EQ(payload(pingBytes(PingProtocolVersion{})), 4u);
    EXPECT_EQ(payload(pingBytes(Ping1dGeneralInfo{})), 10u);
    EXPECT_EQ(payload(pingBytes(Ping1dFirmwareVersion{})), 6u);
    EXPECT_EQ(payload(pingBytes(Ping1dDistanceSimple{})), 5u);
    EXPECT_EQ(payload(pingBytes(Ping1dDistance{})), 24u);
    EXPECT_EQ(payload(pingBytes(Ping1dProfile{})), 26u);
    EXPECT_EQ(payload(pingBytes(Ping1dSetRange{})), 8u);
}

TEST(PingProtocolTest, WrittenMessagesAreReadBack) {
    const Ping360Acoustics acoustics{2, 32, 88, 740, 1024};
    const Ping360Sector sector{10, 390, 3, 50};
    const auto data = there(Ping360DeviceData{1, 123, acoustics, {9, 8, 7}});
    EXPECT_EQ(data.angle, 123);
    EXPECT_EQ(data.acoustics, acoustics);
    EXPECT_THAT(data.data, ElementsAre(9, 8, 7));
    const auto automatic = there(Ping360AutoDeviceData{1, 399, acoustics, sector, {1, 2}});
    EXPECT_EQ(automatic.acoustics, acoustics);
    EXPECT_EQ(automatic.sector, sector);
    EXPECT_THAT(automatic.data, ElementsAre(1, 2));
    EXPECT_EQ(there(Ping360Transducer{0, 200, acoustics, 1, 0}).acoustics, acoustics);
    EXPECT_EQ(there(Ping360AutoTransmit{1, acoustics, sector}).sector, sector);
    EXPECT_EQ(there(PingNack{2601, "angle is 400"}).text, "angle is 400");
    EXPECT_EQ(there(PingText{"words"}).text, "words");
    EXPECT_EQ(there(PingAck{2903}).acked, 2903);
    EXPECT_EQ(there(Ping1dSetSpeedOfSound{1'450'000}).value, 1'450'000u);
    EXPECT_EQ(there(Ping1dDistanceSimple{12'345, 77}).confidence, 77);
}

TEST(PingProtocolTest, FieldsAreAtTheOffsetsOfTheirDefinitions) {
    const Bytes bytes = pingBytes(
        Ping360AutoDeviceData{1, 0x0203, {4, 0x0506, 0x0708, 0x090a, 0x0b0c}, {0x0d0e, 0x0f10, 0x11, 0x12}, {0x55}});
    EXPECT_THAT(Bytes(bytes.begin() + 8, bytes.end() - 2),
                ElementsAre(1, 4, 3, 2, 6, 5, 8, 7, 0xa, 9, 0xe, 0xd, 0x10, 0xf, 0x11, 0x12, 0xc, 0xb, 1, 0, 0x55));
}

TEST(PingProtocolTest, RejectsAShortMessageAndReadsALongOne) {
    PingFrame frame{Ping360Transducer::message, 0, 0, Bytes(13)};
    EXPECT_FALSE(pingMessage<Ping360Transducer>(frame));
    frame.payload.resize(20);
    EXPECT_TRUE(pingMessage<Ping360Transducer>(frame));
    EXPECT_FALSE(pingMessage<Ping360Reset>(frame)) << "another message";
    PingFrame data{Ping360DeviceData::message, 0, 0, Bytes(20)};
    data.payload[12] = 7;
    EXPECT_FALSE(pingMessage<Ping360DeviceData>(data)) << "six bytes instead of the stated seven";
    data.payload[12] = 6;
    EXPECT_TRUE(pingMessage<Ping360DeviceData>(data));
}

TEST(PingProtocolTest, FramesAreFoundInPiecesOfAnySize) {
    const Bytes line = pingBytes(PingGeneralRequest{5}) + pingBytes(Ping360MotorOff{}) + pingBytes(Ping360Transducer{});
    for (size_t step = 1; step <= line.size(); ++step) {
        PingFrameReader reader(64);
        std::vector<uint16_t> found;
        for (size_t at = 0; at < line.size(); at += step) {
            reader.add(std::span(line).subspan(at, std::min(step, line.size() - at)));
            for (const uint16_t message : messagesIn(reader)) found.push_back(message);
        }
        EXPECT_THAT(found, ElementsAre(6, 2903, 2601)) << step;
        EXPECT_EQ(reader.waiting(), 0u);
    }
}

TEST(PingProtocolTest, SkipsBytesBetweenFrames) {
    const Bytes request = pingBytes(PingGeneralRequest{5}), noise = {0, 'U', 'B', 'B', 'R', 0xff, 0xff, 'B'};
    EXPECT_THAT(messagesIn(noise + request + noise + request), ElementsAre(6, 6));
}

TEST(PingProtocolTest, SkipsAFrameWithAWrongSumAndFindsTheNext) {
    const Bytes request = pingBytes(PingGeneralRequest{5});
    for (size_t at = 0; at < request.size(); ++at) {
        Bytes damaged = request;
        damaged[at] ^= 0x10;
        EXPECT_THAT(messagesIn(damaged), IsEmpty()) << at;
        EXPECT_THAT(messagesIn(damaged + request + request), ElementsAre(6, 6)) << at;
    }
}

TEST(PingProtocolTest, AFalseBeginningDoesNotDelayACompleteFrame) {
    const Bytes stray = {'B', 'R', 30, 0, 1, 2}, request = pingBytes(PingGeneralRequest{5});
    PingFrameReader reader(64);
    reader.add(stray);
    EXPECT_THAT(messagesIn(reader), IsEmpty());
    reader.add(request);
    EXPECT_THAT(messagesIn(reader), ElementsAre(6)) << "before the 40 bytes of the false beginning have arrived";
}

TEST(PingProtocolTest, KeepsNoMoreThanTheLongestFrame) {
    PingFrameReader reader(64);
    const Bytes junk(1 << 16, 'B');
    reader.add(junk);
    EXPECT_FALSE(reader.next());
    EXPECT_LE(reader.waiting(), 74u);
    reader.add(Bytes{'B', 'R', 65, 0});
    EXPECT_FALSE(reader.next());
    EXPECT_EQ(reader.waiting(), 0u) << "longer than any accepted frame";
    EXPECT_THAT(pingFrames(PingFrame{7, 0, 0, Bytes(65)}.bytes(), 64), IsEmpty());
    EXPECT_EQ(pingFrames(PingFrame{7, 0, 0, Bytes(64)}.bytes(), 64).size(), 1u);
}

TEST(PingProtocolTest, FindsEveryIntactFrameOfANoisyLine) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> byte(0, 255), length(0, 40);
    Bytes line;
    for (int i = 0; i < 1000; ++i) {
        for (int n = length(random); n > 0; --n) line.push_back(static_cast<uint8_t>(byte(random)));
        line = line + pingBytes(Ping360Transducer{1, static_cast<uint16_t>(i % 400), {}, 0, 0});
    }
    PingFrameReader reader(64);
    int found = 0;
    for (size_t at = 0; at < line.size(); at += 7) {
        reader.add(std::span(line).subspan(at, std::min<size_t>(7, line.size() - at)));
        while (const auto frame = reader.next()) {
            const auto command = pingMessage<Ping360Transducer>(*frame);
            ASSERT_TRUE(command);
            EXPECT_EQ(command->angle, found++ % 400);
        }
    }
    EXPECT_EQ(found, 1000);
}

}  // namespace
}  // namespace insonify::device
