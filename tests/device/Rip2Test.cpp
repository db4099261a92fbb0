// The Range Image Protocol by bytes; Sonar3dClientTest tests it with the maker's own client.
#include <gmock/gmock.h>

#include <cmath>

#include "components/device/sonar3d/Protobuf.hpp"
#include "components/device/sonar3d/Rip2.hpp"

namespace insonify::device {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

RangePixels someRanges() {
    RangePixels image;
    image.time = {1'700'000'000'123'456};
    image.sequence = 300;
    image.speed_of_sound = 1491;
    image.range = 15;
    image.frequency_hz = 1'200'000;
    image.width = 3;
    image.height = 2;
    image.field_of_view_deg = 90;
    image.vertical_opening_deg = 40;
    image.pixel_scale = 0.001F;
    image.pixels = {0, 1, 127, 128, 5000, 65535};
    return image;
}

StrengthPixels someStrengths() {
    StrengthPixels image;
    static_cast<RipImage&>(image) = someRanges();
    image.pixels = {0, 1, 2, 3, 254, 255};
    return image;
}

void expectSameFrame(const RipImage& got, const RipImage& sent) {
    EXPECT_EQ(got.time, sent.time);
    EXPECT_EQ(got.sequence, sent.sequence);
    EXPECT_EQ(got.speed_of_sound, sent.speed_of_sound);
    EXPECT_EQ(got.range, sent.range);
    EXPECT_EQ(got.frequency_hz, sent.frequency_hz);
    EXPECT_EQ(got.width, sent.width);
    EXPECT_EQ(got.height, sent.height);
    EXPECT_EQ(got.field_of_view_deg, sent.field_of_view_deg);
    EXPECT_EQ(got.vertical_opening_deg, sent.vertical_opening_deg);
}

std::string findDiagnostic(const Bytes& bytes) {
    std::vector<std::string> diagnostics;
    EXPECT_THAT(ripMessages(bytes, &diagnostics), IsEmpty());
    return diagnostics.empty() ? "" : diagnostics.front();
}

/** Appends the CRC-32, computed bit by bit. */
Bytes withSum(Bytes bytes) {
    uint32_t crc = 0xFFFFFFFF;
    for (const uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320 : 0);
    }
    append(bytes, ~crc);
    return bytes;
}

/** Returns a packet with a foreign payload, of the right length and checksum. */
Bytes packed(const Bytes& payload) {
    RangePixels empty;
    Bytes bytes = ripPacket(empty, RipVersion::Rip1);
    bytes.resize(8);
    write(bytes, 4, static_cast<uint32_t>(payload.size() + 12));
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    return withSum(bytes);
}

Bytes wrapped(std::string_view type, const Bytes& message) {
    ProtobufWriter any, whole;
    any.text(1, type);
    any.bytes(2, message);
    whole.bytes(1, any.message());
    return packed(whole.message());
}

TEST(Rip2Test, BothImagesAreReadBackInBothVersions) {
    for (const RipVersion version : {RipVersion::Rip1, RipVersion::Rip2}) {
        const auto ranges = ripMessages(ripPacket(someRanges(), version));
        ASSERT_EQ(ranges.size(), 1u);
        const auto& image = std::get<RangePixels>(ranges[0]);
        expectSameFrame(image, someRanges());
        EXPECT_EQ(image.pixel_scale, 0.001F);
        EXPECT_EQ(image.pixels, someRanges().pixels);
        const auto strengths = ripMessages(ripPacket(someStrengths(), version));
        ASSERT_EQ(strengths.size(), 1u);
        expectSameFrame(std::get<StrengthPixels>(strengths[0]), someStrengths());
        EXPECT_EQ(std::get<StrengthPixels>(strengths[0]).pixels, someStrengths().pixels);
    }
}

/** The fields made by hand, from their numbers and wire types. */
TEST(Rip2Test, ASmallPacketHasTheBytesOfItsMakersFields) {
    RangePixels image;
    image.width = 2;
    image.height = 1;
    image.pixel_scale = 0.5F;
    image.pixels = {7, 300};
    const Bytes message = {0x0A, 2, 0x0A, 0, 0x28, 2, 0x30, 1, 0x4D, 0, 0, 0, 0x3F, 0x52, 3, 7, 0xAC, 2};
    const Bytes expected = wrapped("type.googleapis.com/waterlinked.sonar.protocol.RangeImage", message);
    EXPECT_EQ(ripPacket(image, RipVersion::Rip1), expected);
}

TEST(Rip2Test, AWholeImageOfNoiseFitsIntoADatagram) {
    RangePixels image = someRanges();
    image.width = 256;
    image.height = 64;
    image.pixels.clear();
    for (uint32_t i = 0; i < 256 * 64; ++i) image.pixels.push_back(i * 2654435761u >> 16);
    const Bytes packet = ripPacket(image);
    EXPECT_LE(packet.size(), max_rip_packet);
    EXPECT_EQ(std::get<RangePixels>(ripMessages(packet).at(0)).pixels, image.pixels);
}

TEST(Rip2Test, FindsPacketsAmongOtherBytes) {
    Bytes all = {'R', 'I', 'P', 'R', 'I', 'P', '2'};
    const Bytes unknown = wrapped("type.googleapis.com/waterlinked.sonar.protocol.ImuBatch", {8, 1});
    for (const Bytes& packet : {ripPacket(someRanges()), unknown, ripPacket(someStrengths(), RipVersion::Rip1)})
        all.insert(all.end(), packet.begin(), packet.end());
    all.push_back('R');
    const auto messages = ripMessages(all);
    ASSERT_EQ(messages.size(), 3u);
    EXPECT_TRUE(std::holds_alternative<RangePixels>(messages[0]));
    EXPECT_EQ(std::get<OtherRipMessage>(messages[1]).type, "waterlinked.sonar.protocol.ImuBatch");
    EXPECT_TRUE(std::holds_alternative<StrengthPixels>(messages[2]));
}

TEST(Rip2Test, RejectsShortLongAndDamagedPackets) {
    const Bytes whole = ripPacket(someRanges());
    for (size_t length = 4; length < whole.size(); ++length)
        EXPECT_THAT(findDiagnostic({whole.begin(), whole.begin() + static_cast<long>(length)}), HasSubstr("is cut off"))
            << length;
    for (size_t at = 8; at < whole.size(); ++at) {
        Bytes changed = whole;
        changed[at] ^= 0x10;
        EXPECT_THAT(findDiagnostic(changed), HasSubstr("has a wrong checksum")) << at;
    }
    for (const uint32_t length : {0u, 11u, 65508u, 0xFFFFFFFFu}) {
        Bytes changed = whole;
        write(changed, 4, length);
        EXPECT_THAT(findDiagnostic(changed), HasSubstr("may have 12 to 65507")) << length;
    }
    Bytes longer = whole;
    longer.insert(longer.end(), 9, 0);
    EXPECT_EQ(ripMessages(longer).size(), 1u) << "and the bytes behind it are skipped";
}

TEST(Rip2Test, ReportsContradictionsWithTheirNumbers) {
    RangePixels fewer = someRanges();
    fewer.pixels.pop_back();
    EXPECT_THAT(findDiagnostic(ripPacket(fewer)), HasSubstr("has 5 pixels, but its header has 3 x 2"));
    RangePixels large = someRanges();
    large.pixels[3] = 65536;
    EXPECT_THAT(findDiagnostic(ripPacket(large)), HasSubstr("has a pixel of 65536"));
    RangePixels unscaled = someRanges();
    unscaled.pixel_scale = NAN;
    EXPECT_THAT(findDiagnostic(ripPacket(unscaled)), HasSubstr("has a pixel scale of nan"));
    StrengthPixels endless = someStrengths();
    endless.range = INFINITY;
    EXPECT_THAT(findDiagnostic(ripPacket(endless)), HasSubstr("has a value of inf"));
    StrengthPixels missing = someStrengths();
    missing.height = 4;
    EXPECT_THAT(findDiagnostic(ripPacket(missing)), HasSubstr("has 6 pixels, but its header has 3 x 4"));
    EXPECT_THAT(findDiagnostic(packed({0x0A, 5, 1})), HasSubstr("holds no message"));
    EXPECT_THAT(findDiagnostic(packed({})), HasSubstr("holds no message"));
    const std::string type = "type.googleapis.com/waterlinked.sonar.protocol.RangeImage";
    EXPECT_THAT(findDiagnostic(wrapped(type, {0x52, 2, 0x80, 0x80})), HasSubstr("has pixels that are cut off"));
    EXPECT_THAT(findDiagnostic(wrapped(type, {0x28})), HasSubstr("holds a range image that is cut off"));
    EXPECT_THAT(findDiagnostic(wrapped(type, {0x0A, 4, 0x0A, 2, 0x10, 0xFF})), HasSubstr("has a stamp that is none"));
}

TEST(Rip2Test, RejectsAPayloadThatIsNotSnappy) {
    Bytes changed = packed({0xFF, 0xFF, 0xFF, 0xFF, 0x7F, 1, 2, 3});  // says that it has 32 GB
    changed[3] = '2';
    changed.resize(changed.size() - 4);
    EXPECT_THAT(findDiagnostic(withSum(changed)), HasSubstr("is compressed by something else than snappy"));
}

/** Pixels one by one, in another order and with unknown fields, as other writers may send them. */
TEST(Rip2Test, ReadsPacketsOfOtherWriters) {
    const Bytes message = {0x50, 9, 0x28, 1, 0x30, 2, 0x50, 0x80, 1, 0xF8, 7, 1, 0xF9, 7, 1, 2, 3, 4, 5, 6, 7, 8};
    const auto messages = ripMessages(wrapped("type.googleapis.com/waterlinked.sonar.protocol.RangeImage", message));
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_THAT(std::get<RangePixels>(messages[0]).pixels, ElementsAre(9, 128));
}

}  // namespace
}  // namespace insonify::device
