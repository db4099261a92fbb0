// What an Oculus sends, as it lies in captures and in its maker's log files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "components/device/OculusPing.hpp"
#include "tests/support/Fuzz.hpp"
#include "types/ConfigError.hpp"

namespace insonify::fuzz {
namespace {

void expectSound(const device::OculusPing& ping) {
    EXPECT_EQ(ping.codes.size(), size_t{ping.beamCount()} * ping.bin_count);
    EXPECT_TRUE(ping.row_gains.empty() || ping.row_gains.size() == ping.bin_count);
    EXPECT_TRUE(std::ranges::all_of(ping.codes, [&](uint32_t code) { return code <= ping.largestCode(); }));
    EXPECT_TRUE(std::isfinite(ping.frequency_hz) && ping.frequency_hz >= 0) << ping.frequency_hz;
    EXPECT_TRUE(std::isfinite(ping.speed_of_sound) && ping.speed_of_sound >= 0) << ping.speed_of_sound;
    EXPECT_GT(ping.range_resolution, 0);
    EXPECT_GT(ping.gamma, 0);
}

void read(const Input& input) try {
    for (const device::OculusPing& ping : device::readOculusPings(input.file())) expectSound(ping);
} catch (const types::ConfigError& error) {
    expectOurWords(error.what());
}

TEST(OculusFuzzTest, EveryCaptureIsPingsOrAnError) {
    push({"oculus",
          "capture.raw",
          {std::string("\x53\x4f", 2), std::string("\x23\0\1\0", 4), std::string("\x23\0\2\0", 4),
           std::string("\x53\x4f\0\0\0\0\x23\0\1\0", 10)},
          read});
}

}  // namespace
}  // namespace insonify::fuzz
