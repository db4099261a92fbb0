// A receiver's codes as an Oculus sends them, and as drivers read them.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "components/device/OculusPing.hpp"
#include "tests/support/Fans.hpp"

namespace insonify::device {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

/** Two beams, starboard first as in sonars, of three bins in 16 bits. */
types::Sonar codes() {
    types::Sonar ping;
    ping.beam_count = 2;
    ping.bin_count = 3;
    ping.bearings = {types::Angle::fromDeg(-30), types::Angle::fromDeg(30)};
    ping.bins = {0, 6553.5f, 65535, 16384, 32768, 1};
    return ping;
}

/** Returns the ping as a driver reads it. */
OculusPing sent(const types::Sonar& ping, const OculusFire& fire) {
    OculusResult result;
    result.fire = fire;
    result.fire.header.id = static_cast<uint16_t>(OculusId::PingResult);
    result.range_resolution = 0.1;
    OculusEncoder encoder;
    encoder.encode(ping, result);
    result.settle();
    std::string diagnostic;
    const auto read = oculusResult(toBytes(result), &diagnostic);
    EXPECT_EQ(diagnostic, "");
    return makePing(read.value());
}

OculusFire makeFire(int bits, uint8_t flags = 0) {
    OculusFire fire{.flags = flags};
    if (bits == 16) fire.flags |= OculusFire::wide_16;
    if (bits == 32) {
        fire.header.version = 2;
        fire.extended_flags = OculusFire::wide_32;
    }
    return fire;
}

TEST(OculusEncoderTest, CodesOfEveryWidthAreTheSameFractionOfTheMax) {
    for (const int bits : {8, 16, 32}) {
        const OculusPing ping = sent(codes(), makeFire(bits));
        EXPECT_EQ(ping.bits, bits);
        EXPECT_NEAR(ping.bearings[0], types::radians(30), 1e-9) << "port is first";
        const double shares[] = {0.25, 0.5, 1 / 65535., 0, 0.1, 1};
        for (size_t i = 0; i < 6; ++i)
            EXPECT_NEAR(ping.codes[i] / ping.maxCode(), shares[i], 0.5 / ping.maxCode() + 1e-5) << i;
    }
}

TEST(OculusEncoderTest, BearingsOfARandomFanAscendAndBeamsAreReadBackWithTheirCodes) {
    for (const test::RandomFan& fan : test::randomFans(5, 4)) {
        types::Sonar ping = fan.ping;
        for (float& bin : ping.bins) bin = std::floor(65535 * bin);
        OculusResult result;
        result.fire = makeFire(16);
        OculusEncoder encoder;
        encoder.encode(ping, result);
        EXPECT_TRUE(std::ranges::is_sorted(result.bearings)) << fan.name;
        const types::Sonar back = getSonar(sent(ping, makeFire(16)), {});
        ASSERT_EQ(back.beam_count, ping.beam_count);
        for (uint32_t beam = 0; beam < ping.beam_count; ++beam) {
            uint32_t found = 0;
            while (found < back.beam_count && back.bins[found * 4] != ping.bins[beam * 4]) ++found;
            ASSERT_LT(found, back.beam_count) << fan.name;
            EXPECT_LT(test::apart(back.bearings[found].rad, ping.bearings[beam].rad), types::radians(0.0051))
                << fan.name;
        }
        for (size_t beam = 0; beam < back.beam_count; ++beam)
            EXPECT_LE(std::abs(back.bearings[beam].rad), std::numbers::pi) << fan.name;
    }
}

TEST(OculusEncoderTest, BeamsOfUnknownBearingAreNotSent) {
    types::Sonar ping = codes();
    ping.bearings[0] = {};
    const OculusPing read = sent(ping, makeFire(16));
    ASSERT_EQ(read.beamCount(), 1u);
    EXPECT_NEAR(types::degrees(read.bearings[0]), 30, 1e-9);
    EXPECT_THAT(read.codes, ElementsAre(16384, 32768, 1));
}

TEST(OculusEncoderTest, GammaBrightensWeakEchoes) {
    OculusFire fire = makeFire(16);
    fire.gamma = 127;
    const OculusPing ping = sent(codes(), fire);
    EXPECT_NEAR(ping.codes[0] / 65535., std::pow(0.25, 127 / 255.), 1e-4);
    EXPECT_EQ(ping.codes[5], 65535u);
    EXPECT_EQ(ping.codes[3], 0u);
}

TEST(OculusEncoderTest, ARowDividedByTheRootOfItsGainIsTheSameButFiner) {
    const OculusPing ping = sent(codes(), makeFire(8, OculusFire::row_gains));
    ASSERT_EQ(ping.row_gains.size(), 3u);
    EXPECT_THAT(ping.row_gains, ElementsAre(15, 3, 1)) << "(65535 / 16384)^2, (1 / 0.5)^2 - rounding, 1";
    const auto amplitude = [&](size_t beam, size_t bin) {
        return ping.codes[beam * 3 + bin] / std::sqrt(ping.row_gains[bin]) / 255;
    };
    EXPECT_NEAR(amplitude(0, 0), 0.25, 0.5 / 255 / std::sqrt(15) + 1e-4);
    EXPECT_NEAR(amplitude(1, 1), 0.1, 0.5 / 255 / std::sqrt(3) + 1e-4);
    EXPECT_NEAR(amplitude(1, 2), 1, 1e-9);
}

TEST(OculusEncoderTest, SilentAndUnknownBinsAreCodeZero) {
    types::Sonar ping = codes();
    ping.bins = {0, -5, std::nanf(""), 1e9f, 65535, 65535};
    const OculusPing plain = sent(ping, makeFire(8)), gained = sent(ping, makeFire(32, OculusFire::row_gains));
    EXPECT_THAT(plain.codes, ElementsAre(255, 255, 255, 0, 0, 0));
    ping.bins.assign(6, 0);
    const OculusPing silent = sent(ping, makeFire(16, OculusFire::row_gains));
    EXPECT_THAT(silent.codes, Each(0u));
    EXPECT_THAT(silent.row_gains, Each(4294967295u));
    EXPECT_THAT(gained.row_gains, Each(1u));
}

}  // namespace
}  // namespace insonify::device
