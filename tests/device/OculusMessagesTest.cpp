// Messages of an Oculus by their bytes, and read from damaged streams.
#include <gmock/gmock.h>

#include "components/device/oculus/OculusMessages.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/OculusMessage.hpp"
#include "tests/support/Paths.hpp"

namespace insonify::device {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

OculusFire fireOfVersion(uint16_t version) {
    OculusFire fire{.mode = 2, .rate = 3, .network_speed = 7, .gamma = 127, .flags = 0x5F};
    fire.header.version = version;
    fire.range = 12.5;
    fire.gain_percent = 61;
    fire.speed_of_sound = 1490;
    fire.salinity = 34;
    if (version == 2) {
        fire.extended_flags = OculusFire::wide_32;
        fire.reserved[7] = 9;
    }
    return fire;
}

/** Returns all messages that a framer finds, with the bytes added in pieces of this size. */
std::vector<Bytes> framed(std::span<const uint8_t> bytes, size_t step, OculusFramer framer = OculusFramer(4096)) {
    std::vector<Bytes> messages;
    for (size_t at = 0; at < bytes.size(); at += step) {
        framer.add(bytes.subspan(at, std::min(step, bytes.size() - at)));
        for (Bytes message = framer.next(); !message.empty(); message = framer.next()) messages.push_back(message);
    }
    return messages;
}

Bytes joined(std::initializer_list<Bytes> parts) {
    Bytes all;
    for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

Bytes recording(const char* name) {
    const std::vector<char> bytes = insonify::toBytes(std::filesystem::path(test::sharedFile("sonar/oculus")) / name);
    return {bytes.begin(), bytes.end()};
}

TEST(OculusMessagesTest, AFireMessageHasItsFieldsAtTheOffsetsOfDrivers) {
    for (const uint16_t version : {1, 2}) {
        const Bytes bytes = toBytes(fireOfVersion(version));
        ASSERT_EQ(bytes.size(), version == 2 ? 89u : 53u);
        EXPECT_EQ(read<uint16_t>(bytes, 0), 0x4F53);
        EXPECT_EQ(read<uint16_t>(bytes, 6), 0x15);
        EXPECT_EQ(read<uint32_t>(bytes, 10), bytes.size() - 16);
        EXPECT_THAT(Bytes(bytes.begin() + 16, bytes.begin() + 21), ElementsAre(2, 3, 7, 127, 0x5F));
        EXPECT_EQ(read<double>(bytes, 21), 12.5);
        EXPECT_EQ(read<double>(bytes, 29), 61);
        EXPECT_EQ(read<double>(bytes, 37), 1490);
        EXPECT_EQ(read<double>(bytes, 45), 34);
        const auto fire = oculusFire(bytes);
        ASSERT_TRUE(fire);
        EXPECT_EQ(toBytes(*fire), bytes);
        EXPECT_EQ(fire->codeBytes(), version == 2 ? 4u : 2u) << "32 bits are requested in version 2 only";
        EXPECT_EQ(fire->rateHz(), 5);
        EXPECT_NEAR(fire->gammaExponent(), 0.5, 0.002);
    }
    EXPECT_EQ(read<uint32_t>(toBytes(fireOfVersion(2)), 53), 0x200u);
}

TEST(OculusMessagesTest, RatesAreThoseOfTheDevice) {
    OculusFire fire;
    std::vector<double> rates;
    for (fire.rate = 0; fire.rate < 7; ++fire.rate) rates.push_back(fire.rateHz());
    EXPECT_THAT(rates, ElementsAre(10, 15, 40, 5, 2, 0, 10));
}

TEST(OculusMessagesTest, AFireMessageOfPayloadSizeZeroIsAsLongAsItsVersion) {
    for (const uint16_t version : {0, 1, 2}) {
        Bytes bytes = toBytes(fireOfVersion(version));
        write<uint32_t>(bytes, 10, 0);
        const auto messages = framed(joined({bytes, bytes}), 1);
        ASSERT_THAT(messages, SizeIs(2)) << version;
        EXPECT_EQ(messages[1], bytes);
        EXPECT_EQ(oculusFire(messages[1])->gain_percent, 61);
    }
}

TEST(OculusMessagesTest, ShortAndLongFireMessagesAreRead) {
    const Bytes whole = toBytes(fireOfVersion(2));
    for (size_t size = 0; size < 53; ++size) EXPECT_FALSE(oculusFire(std::span(whole).first(size))) << size;
    EXPECT_EQ(oculusFire(std::span(whole).first(53))->extended_flags, 0u);
    EXPECT_EQ(oculusFire(joined({whole, Bytes(100, 0xEE)}))->salinity, 34);
    EXPECT_FALSE(oculusFire(oculusDummy(1, 2))) << "another message";
}

TEST(OculusMessagesTest, PingsOfEveryVersionAndWidthAreEncodedAsTheyWereRead) {
    for (const uint16_t version : {0, 1, 2})
        for (const uint8_t width : {1, 2, 3, 4})
            for (const bool gains : {false, true}) {
                const Bytes bytes =
                    test::OculusMessage{.version = version, .code_bytes = width, .gains = gains}.bytes();
                const auto result = oculusResult(bytes);
                ASSERT_TRUE(result);
                EXPECT_EQ(toBytes(*result), bytes);
                OculusResult settled = *result;
                settled.settle();
                EXPECT_EQ(settled.image_offset, result->image_offset);
                EXPECT_EQ(settled.image_size, result->image_size);
                EXPECT_EQ(settled.fire.header.payload_size, bytes.size() - 16);
                EXPECT_EQ(settled.message_size, bytes.size());
            }
}

TEST(OculusMessagesTest, RealPingsAreEncodedByteForByte) {
    for (const auto& [name, count] : {std::pair{"one_ping_8bit.raw", 1u}, {"three_pings_8bit.raw", 3u}}) {
        const Bytes bytes = recording(name);
        if (bytes.empty()) GTEST_SKIP() << name << " is missing: no recording of a device is tested";
        const auto messages = framed(bytes, 4096, OculusFramer());
        ASSERT_THAT(messages, SizeIs(count));
        Bytes again;
        for (const Bytes& message : messages) {
            std::string diagnostic;
            const auto result = oculusResult(message, &diagnostic);
            ASSERT_TRUE(result) << diagnostic;
            EXPECT_EQ(result->before_image.size(), 1414u) << "the device leaves old bytes there";
            EXPECT_EQ(result->fire.rate, 0xC3) << "the device does not echo the rate";
            EXPECT_EQ(result->fire.range, 2);
            again = joined({again, toBytes(*result)});
        }
        EXPECT_EQ(again, bytes);
    }
}

TEST(OculusMessagesTest, AStatusHas142BytesWithFieldsAtTheOffsetsOfListeners) {
    OculusStatus status{.device_id = 7892, .part = 1042, .address = {192, 168, 2, 3}, .pressure_bar = 1.5};
    status.header.source = 7892;
    const Bytes bytes = toBytes(status);
    ASSERT_EQ(bytes.size(), 142u);
    EXPECT_EQ(read<uint16_t>(bytes, 2), 7892);
    EXPECT_EQ(read<uint32_t>(bytes, 16), 7892u);
    EXPECT_EQ(read<uint16_t>(bytes, 20), 1);
    EXPECT_EQ(read<uint16_t>(bytes, 22), 1042);
    EXPECT_EQ(read<uint32_t>(bytes, 24) & 7, 3u);
    EXPECT_THAT(Bytes(bytes.begin() + 52, bytes.begin() + 56), ElementsAre(192, 168, 2, 3));
    EXPECT_EQ(read<double>(bytes, 134), 1.5);
    EXPECT_EQ(toBytes(oculusStatus(bytes).value()), bytes);
    EXPECT_FALSE(oculusStatus(std::span(bytes).first(141)));
    EXPECT_FALSE(oculusStatus(joined({bytes, {0}})));
}

TEST(OculusMessagesTest, UserConfigDummyAndLogAreMessages) {
    OculusUserConfig config{.address = {10, 0, 0, 2}, .mask = {255, 255, 255, 0}, .dhcp = 1};
    const Bytes bytes = toBytes(config);
    ASSERT_EQ(bytes.size(), 28u);
    EXPECT_EQ(toBytes(oculusUserConfig(bytes).value()), bytes);
    EXPECT_FALSE(oculusUserConfig(std::span(bytes).first(27)));
    EXPECT_EQ(oculusDummy(5, 1032).size(), 16u);
    EXPECT_TRUE(oculusHeader(oculusDummy(5, 1032))->is(OculusId::Dummy));
    const Bytes log = oculusLog(5, 1032, "warm");
    EXPECT_EQ(std::string(log.begin() + 16, log.end()), "warm");
    EXPECT_THAT(framed(joined({bytes, oculusDummy(5, 1032), log}), 3), ElementsAre(bytes, oculusDummy(5, 1032), log));
}

TEST(OculusMessagesTest, AStreamContinuesAfterInvalidBytes) {
    const Bytes fire = toBytes(fireOfVersion(1)), noise = {'S', 'O', 0, 'S', 0xFF, 'S', 'O'};
    for (const size_t step : {1, 7, 1000})
        EXPECT_THAT(framed(joined({noise, fire, noise, noise, fire, Bytes(40, 'S'), fire}), step),
                    ElementsAre(fire, fire, fire));
    for (const uint32_t size : {1u, 36u, 257u, 100'000u, 0xFFFFFFFFu}) {  // sizes that no fire message has
        Bytes wrong = fire;
        write<uint32_t>(wrong, 10, size);
        EXPECT_THAT(framed(joined({wrong, fire}), 1000), ElementsAre(fire)) << size;
    }
    Bytes unknown = oculusDummy(1, 2);
    write<uint16_t>(unknown, 6, 0x4711);
    EXPECT_THAT(framed(joined({unknown, fire}), 10), ElementsAre(fire));
    write<uint16_t>(unknown, 6, 0x80);
    write<uint32_t>(unknown, 10, 4097);
    EXPECT_THAT(framed(joined({unknown, fire}), 10), ElementsAre(fire));
}

TEST(OculusMessagesTest, ATruncatedStreamGivesItsCompleteMessages) {
    const Bytes fire = toBytes(fireOfVersion(2)), two = joined({fire, fire});
    for (size_t size = 0; size < two.size(); ++size)
        EXPECT_EQ(framed(std::span(two).first(size), 16).size(), size / fire.size());
    OculusFramer framer(4096);
    framer.add(Bytes(1'000'000, 'S'));
    EXPECT_THAT(framer.next(), IsEmpty());
    EXPECT_GT(framer.skipped(), 999'000u);
}

}  // namespace
}  // namespace insonify::device
