#include <gmock/gmock.h>

#include <cmath>

#include "components/device/OculusPing.hpp"
#include "components/device/OculusRecording.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/OculusMessage.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Refused.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::device {
namespace {

using test::Bytes;
using test::put;
using Sent = test::OculusMessage;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/** Returns the pings in a stream of messages. @param diagnostics receives what is wrong with the others, unless null */
std::vector<OculusPing> pingsIn(std::span<const uint8_t> bytes, std::vector<std::string>* diagnostics = nullptr) {
    OculusFramer framer;
    framer.add(bytes);
    std::vector<OculusPing> pings;
    for (Bytes message = framer.next(); !message.empty(); message = framer.next()) {
        if (!oculusHeader(message)->is(OculusId::PingResult)) continue;
        std::string diagnostic;
        const auto result = oculusResult(message, &diagnostic);
        if (result) pings.push_back(makePing(*result));
        if (!result && diagnostics) diagnostics->push_back(diagnostic);
    }
    return pings;
}

TEST(OculusPingTest, APingIsReadInEveryVersionAndWidth) {
    for (const uint16_t version : {0, 1, 2})
        for (const bool gains : {false, true}) {
            const Bytes bytes = Sent{.version = version, .gains = gains}.bytes();
            const auto pings = pingsIn(bytes);
            ASSERT_EQ(pings.size(), 1u) << version;
            const OculusPing& ping = pings[0];
            EXPECT_EQ(ping.number, 77u);
            EXPECT_EQ(ping.frequency_hz, 2.1e6);
            EXPECT_EQ(ping.speed_of_sound, 1490.5);
            EXPECT_EQ(ping.range_resolution, 0.25);
            EXPECT_NEAR(ping.gamma, 0.5, 0.003);
            EXPECT_EQ(ping.beamCount(), 3u);
            EXPECT_EQ(ping.bin_count, 2u);
            EXPECT_NEAR(ping.bearings[0], types::radians(30), 1e-12) << "positive to port";
            EXPECT_THAT(ping.codes, ElementsAre(0, 1, 10, 11, 20, 21)) << "beam-first";
            EXPECT_EQ(ping.row_gains.size(), gains ? 2u : 0u);
        }
    const OculusPing wide = pingsIn(Sent{.code_bytes = 2}.bytes()).at(0);
    EXPECT_THAT(wide.codes, ElementsAre(256, 257, 266, 267, 276, 277));
    EXPECT_EQ(wide.maxCode(), 65535);
}

TEST(OculusPingTest, AMissingSpeedOfSoundIs1500) {
    OculusPing ping = pingsIn(Sent{}.bytes()).at(0);
    ping.speed_of_sound = 0;
    const types::Sonar sonar = getSonar(ping, {});
    EXPECT_EQ(sonar.speed_of_sound, 1500);
    EXPECT_EQ(sonar.bin_duration.microseconds, 167) << "0.25 m";
}

TEST(OculusPingTest, RangesAreThoseOfTheRangeResolution) {
    OculusPing ping = pingsIn(Sent{}.bytes()).at(0);
    for (const double resolution : {0.0015, 0.002, 0.0025, 0.01}) {
        ping.range_resolution = resolution;
        const types::Sonar sonar = getSonar(ping, {});
        EXPECT_NEAR(sonar.binStart(1600), 1600 * resolution, 2e-6 * 1600 * resolution);
        EXPECT_EQ(sonar.speed_of_sound, 1490.5f) << "of the water";
    }
}

TEST(OculusPingTest, FindsPingsAmongOtherMessages) {
    Bytes all = {'S', 'O', 0, 0, 'S'};
    for (int i = 0; i < 3; ++i) {
        Bytes other(40);
        put<uint16_t>(other, 0, 0x4F53);
        put<uint16_t>(other, 6, 0xFF);
        for (const Bytes& part : {other, Sent{}.bytes()}) all.insert(all.end(), part.begin(), part.end());
    }
    EXPECT_EQ(pingsIn(all).size(), 3u);
}

TEST(OculusPingTest, RejectsPingsThatContradictThemselves) {
    std::vector<std::string> diagnostics;
    Bytes bytes = Sent{}.bytes();
    put<uint32_t>(bytes, 114, 7);
    EXPECT_THAT(pingsIn(bytes, &diagnostics), IsEmpty());
    EXPECT_THAT(diagnostics, ElementsAre(HasSubstr("an image of 7 bytes where bins and beams make 6")));
    for (size_t length = 0; length < Sent{}.bytes().size(); ++length) {
        const Bytes whole = Sent{}.bytes();
        EXPECT_THAT(pingsIn(std::span(whole).first(length)), IsEmpty()) << length;
    }
    for (const auto& [at, words] : {std::pair{61, "a frequency of nan Hz"}, {85, "a speed of sound of nan m/s"}}) {
        Bytes changed = Sent{}.bytes();
        put<double>(changed, static_cast<size_t>(at), std::nan(""));
        diagnostics.clear();
        EXPECT_THAT(pingsIn(changed, &diagnostics), IsEmpty());
        EXPECT_THAT(diagnostics, ElementsAre(HasSubstr(words)));
    }
    for (size_t at = 16; at < 128; ++at)  // for any value there, no byte beyond the message is read
        for (const uint8_t value : {0, 1, 127, 255}) {
            Bytes changed = Sent{}.bytes();
            changed[at] = value;
            EXPECT_LE(pingsIn(changed).size(), 1u);
        }
}

TEST(OculusPingTest, AFileWithoutAPingIsRefusedWithTheReason) {
    const Folder folder;
    const auto makeMessage = [&](const Bytes& bytes) -> std::string {
        std::ofstream(folder / "a.raw", std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return test::computeError<types::ConfigError>([&] { OculusReader(folder / "a.raw").next(); });
    };
    EXPECT_THAT(makeMessage({1, 2, 3}), HasSubstr("a.raw: holds no ping of an Oculus"));
    Bytes cut = Sent{}.bytes();
    cut.resize(100);
    EXPECT_THAT(makeMessage(cut), HasSubstr("holds no ping of an Oculus, and does not begin as a .xtf, "));
    EXPECT_THAT(makeMessage(cut), HasSubstr("; the message at byte 0 is longer than the file"));
    EXPECT_EQ(makeMessage(Sent{}.bytes()), "");
    EXPECT_THROW(OculusReader(folder / "missing.raw"), types::ConfigError);
    EXPECT_THROW(OculusReader(folder / "."), types::ConfigError);
}

TEST(OculusPingTest, ReadsTheRecordingOfAnM1200d) {
    const std::filesystem::path file = test::sharedFile("sonar/oculus/three_pings_8bit.raw");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is missing: no recording of a device is tested";
    OculusReader reader(file);
    std::vector<recordings::RecordedPing> pings;
    while (auto ping = reader.next()) pings.push_back(std::move(*ping));
    ASSERT_EQ(pings.size(), 3u);
    for (const recordings::RecordedPing& read : pings) {
        EXPECT_EQ(read.ping.beam_count, 256u);
        EXPECT_EQ(read.ping.bin_count, 703u);
        EXPECT_NEAR(read.ping.binStart(1), 2.842e-3, 1e-6);
        EXPECT_NEAR(read.range, 703 * 2.842e-3, 1e-3);
        EXPECT_NEAR(read.frequency_khz, 2098.9, 0.1);
        EXPECT_NEAR(read.ping.bearings.front().deg(), -30, 1e-9) << "starboard first";
        EXPECT_NEAR(read.ping.bearings.back().deg(), 30, 1e-9);
        EXPECT_EQ(read.max_code, 255);
        EXPECT_EQ(read.code.law, receiver::CodeLaw::Sqrt);
    }
    EXPECT_NEAR(pings[2].since_first, 0.2, 1e-3);
    EXPECT_EQ(pings[2].number, pings[0].number + 2);
}

}  // namespace
}  // namespace insonify::device
