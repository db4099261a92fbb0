// Packets of a Sonar 3D-15, in datagrams and in its maker's log files.
#include <gtest/gtest.h>

#include <cmath>

#include "components/device/sonar3d/Rip2.hpp"
#include "tests/support/Fuzz.hpp"

namespace insonify::fuzz {
namespace {

using namespace device;

/** Corrects length and checksum of damaged packets, so that their content is read. */
Bytes mended(std::span<const uint8_t> bytes) {
    Bytes whole(bytes.begin(), bytes.end());
    if (whole.size() < 12 || whole.size() > max_rip_packet) return whole;
    write(whole, 4, static_cast<uint32_t>(whole.size()));
    uint32_t crc = 0xFFFFFFFF;
    for (size_t i = 0; i < whole.size() - 4; ++i) {
        crc ^= whole[i];
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320 : 0);
    }
    write(whole, whole.size() - 4, ~crc);
    return whole;
}

void expectSound(const RipImage& image, size_t pixels) {
    EXPECT_EQ(uint64_t{image.width} * image.height, pixels);
    EXPECT_TRUE(std::isfinite(image.range) && std::isfinite(image.speed_of_sound));
    EXPECT_TRUE(std::isfinite(image.field_of_view_deg) && std::isfinite(image.vertical_opening_deg));
}

void expectSound(std::span<const uint8_t> bytes) {
    std::vector<std::string> diagnostics;
    for (const RipMessage& message : ripMessages(bytes, &diagnostics)) {
        if (const auto* ranges = std::get_if<RangePixels>(&message)) {
            expectSound(*ranges, ranges->pixels.size());
            EXPECT_TRUE(std::isfinite(ranges->pixel_scale));
            const auto again = ripMessages(ripPacket(*ranges, RipVersion::Rip1));
            EXPECT_TRUE(again.empty() || std::get<RangePixels>(again[0]).pixels == ranges->pixels);
        }
        if (const auto* strengths = std::get_if<StrengthPixels>(&message))
            expectSound(*strengths, strengths->pixels.size());
    }
    for (const std::string& diagnostic : diagnostics) expectOurWords(diagnostic);
}

void readRip(const Input& input) {
    const auto bytes = input.octets();
    expectSound(bytes);
    expectSound(mended(bytes));
}

TEST(RipFuzzTest, EveryDatagramIsImagesOrNothing) {
    push({"rip",
          "images.sonar",
          {"RIP1", "RIP2", "type.googleapis.com/waterlinked.sonar.protocol.RangeImage",
           "type.googleapis.com/waterlinked.sonar.protocol.BitmapImageGreyscale8", std::string("\x52\x03", 2),
           std::string("\xFF\xFF\xFF\xFF\x0F", 5)},
          readRip});
}

}  // namespace
}  // namespace insonify::fuzz
