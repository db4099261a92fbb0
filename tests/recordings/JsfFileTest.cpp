// Reading of JSF files, made here by EdgeTech's published layout, intact and damaged.
#include <gmock/gmock.h>

#include "components/recordings/JsfFile.hpp"
#include "tests/recordings/RecordedFileTest.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/RecordedBytes.hpp"

namespace insonify::recordings {
namespace {

using test::putAt;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/** A message of sonar data, whose samples count up from `begin`. Offsets are those of the layout, behind a header
 * of 16.
 */
std::vector<char> sonarData(uint32_t number, uint8_t channel, uint16_t begin, uint16_t count = 4) {
    std::vector<char> bytes(16 + 240 + 2 * count);
    putAt(bytes, 0, uint16_t{0x1601});
    putAt(bytes, 2, uint8_t{13});  // version
    putAt(bytes, 4, uint16_t{80});
    putAt(bytes, 7, uint8_t{20});  // subsystem
    putAt(bytes, 8, channel);
    putAt(bytes, 12, static_cast<uint32_t>(bytes.size() - 16));
    putAt(bytes, 16 + 0, int32_t{1'700'000'000 + static_cast<int32_t>(number)});
    putAt(bytes, 16 + 8, number);
    putAt(bytes, 16 + 30, uint16_t{1 | 8 | 32 | 64 | 512 | 1 << 14});  // all fields are valid
    putAt(bytes, 16 + 80, int32_t{-68 * 600'000});                     // longitude, 10000 * minutes
    putAt(bytes, 16 + 84, int32_t{48 * 600'000 + static_cast<int32_t>(number) * 600});
    putAt(bytes, 16 + 88, int16_t{2});
    putAt(bytes, 16 + 114, count);
    putAt(bytes, 16 + 116, uint32_t{40'000});  // ns, two-way: 20 us
    putAt(bytes, 16 + 126, uint16_t{44'000});  // 10 Hz
    putAt(bytes, 16 + 128, uint16_t{46'000});
    putAt(bytes, 16 + 136, int32_t{4'500});  // depth [mm]
    putAt(bytes, 16 + 144, int32_t{6'250});  // altitude [mm]
    putAt(bytes, 16 + 148, 1480.0f);
    putAt(bytes, 16 + 168, int16_t{1});        // samples times 1/2
    putAt(bytes, 16 + 172, uint16_t{33'000});  // heading [deg / 100]
    putAt(bytes, 16 + 174, int16_t{-1820});    // pitch, 10 deg bow down
    putAt(bytes, 16 + 176, int16_t{910});      // roll, 5 deg port up
    putAt(bytes, 16 + 200, uint32_t{80'000'250});
    for (uint16_t i = 0; i < count; ++i) putAt(bytes, size_t{256} + 2 * i, static_cast<uint16_t>(begin + i));
    return bytes;
}

std::vector<char> joined(const std::vector<std::vector<char>>& messages) {
    std::vector<char> bytes;
    for (const auto& message : messages) bytes.insert(bytes.end(), message.begin(), message.end());
    return bytes;
}

struct JsfFileTest : RecordedFileTest {
    JsfFileTest() : RecordedFileTest("line.jsf") {}
};

TEST_F(JsfFileTest, JoinsBothSidesOfAPing) {
    const std::vector<RecordedPing> lines =
        read(joined({sonarData(0, 0, 1000), sonarData(0, 1, 100), sonarData(1, 0, 2000), sonarData(1, 1, 200)}));
    ASSERT_EQ(lines.size(), 2u);
    const types::Sonar& ping = lines[0].ping;
    EXPECT_THAT(ping.bins, ElementsAre(50, 50.5, 51, 51.5, 500, 500.5, 501, 501.5)) << "starboard, port; times 2^-1";
    EXPECT_DOUBLE_EQ(ping.bearings[0].deg(), -90);
    EXPECT_DOUBLE_EQ(ping.bearings[1].deg(), 90);
    EXPECT_EQ(ping.time.microseconds, 1'700'000'000'250'000);
    EXPECT_EQ(ping.bin_duration.microseconds, 20);
    EXPECT_EQ(ping.speed_of_sound, 1480);
    EXPECT_EQ(lines[0].frequency_khz, 450);
    EXPECT_EQ(lines[0].altitude, 6.25);
    EXPECT_EQ(lines[1].ping.time.microseconds, 1'700'000'001'250'000);
}

TEST_F(JsfFileTest, ConvertsPosesToRocksFrames) {
    const std::vector<RecordedPing> lines =
        read(joined({sonarData(0, 0, 1000), sonarData(0, 1, 100), sonarData(1, 0, 2000), sonarData(1, 1, 200)}));
    const types::Pose& pose = lines[1].sonar;
    EXPECT_NEAR(pose.position.x, 111.2, 0.02) << "a thousandth of a degree to the north";
    EXPECT_NEAR(pose.position.y, 0, 1e-9);
    EXPECT_NEAR(pose.position.z, -4.5, 1e-9);
    const glm::dvec3 ahead = pose.orientation * glm::dvec3(1, 0, 0), port = pose.orientation * glm::dvec3(0, 1, 0);
    EXPECT_NEAR(std::atan2(ahead.y, ahead.x), types::radians(30), 1e-3) << "heading 330: to the west of north";
    EXPECT_NEAR(ahead.z, -std::sin(types::radians(10)), 1e-3) << "bow down";
    EXPECT_GT(port.z, 0.08) << "port up";
    EXPECT_THAT(notices_, Contains(HasSubstr("latitude 48.0000000, longitude -68.0000000")));
}

TEST_F(JsfFileTest, KeepsEveryPingIfASideIsMissingOrSettingsChange) {
    const std::vector<RecordedPing> lines =
        read(joined({sonarData(0, 0, 1000), sonarData(1, 0, 2000), sonarData(1, 1, 200, 6), sonarData(2, 1, 300, 9)}));
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0].ping.beam_count, 1u);
    EXPECT_DOUBLE_EQ(lines[0].ping.bearings[0].deg(), 90);
    EXPECT_THAT(lines[1].ping.bins, ElementsAre(100, 100.5, 101, 101.5, 102, 102.5, 1000, 1000.5, 1001, 1001.5, 0, 0));
    EXPECT_EQ(lines[2].ping.bin_count, 9u);
}

TEST_F(JsfFileTest, ReadsTheMagnitudeOfAnalyticDataAndALaterWindow) {
    std::vector<char> message = sonarData(0, 1, 0, 4);
    putAt(message, 16 + 34, int16_t{1});
    putAt(message, 16 + 114, uint16_t{2});
    putAt(message, 16 + 4, uint32_t{3});  // samples before the window
    for (const size_t i : {0, 1, 2, 3}) putAt(message, 256 + 2 * i, static_cast<int16_t>(i % 2 == 0 ? -6 : 8));
    EXPECT_THAT(read(message).front().ping.bins, ElementsAre(0, 0, 0, 5, 5));
}

TEST_F(JsfFileTest, OmitsOtherMessagesWithANotice) {
    std::vector<char> navigation = sonarData(0, 0, 0), high = sonarData(0, 0, 0), raw = sonarData(0, 0, 0);
    putAt(navigation, 4, uint16_t{2002});
    putAt(high, 7, uint8_t{21});
    putAt(raw, 16 + 34, int16_t{2});
    EXPECT_EQ(read(joined({sonarData(0, 1, 1), navigation, high, raw})).size(), 1u);
    EXPECT_THAT(notices_,
                AllOf(Contains(HasSubstr("1 messages of type 2002")), Contains(HasSubstr("1 messages of subsystem 21")),
                      Contains(HasSubstr("1 messages of data format 2"))));
}

TEST_F(JsfFileTest, RefusesAWrongFileWithItsByte) {
    const auto with = [&](size_t at, auto value) {
        std::vector<char> bytes = joined({sonarData(0, 0, 1), sonarData(0, 1, 1)});
        putAt(bytes, at, value);
        return refusal(bytes);
    };
    EXPECT_THAT(with(264, uint16_t{7}), HasSubstr("line.jsf: byte 264: is 0x0007; a message begins with 0x1601"));
    EXPECT_THAT(with(12, int32_t{-1}), HasSubstr("byte 12: the message has -1 bytes"));
    EXPECT_THAT(with(12, int32_t{10}), HasSubstr("byte 12: the message has 10 bytes; sonar data have at least 240"));
    EXPECT_THAT(with(16 + 114, uint16_t{900}), HasSubstr("byte 130: has 900 samples of 2 bytes; 8 bytes are left"));
    EXPECT_THAT(with(16 + 116, uint32_t{0}), HasSubstr("byte 132: the sample interval is 0 ns"));
    EXPECT_THAT(with(16 + 116, uint32_t{80'000}), HasSubstr("both sides of a ping must be alike"));
    EXPECT_THAT(with(16 + 4, uint32_t{1u << 30}), HasSubstr("the samples begin at number 1073741824"));
    EXPECT_THAT(with(16 + 0, int32_t{0}), HasSubstr("neither the time since 1970 nor year 0"));
}

TEST_F(JsfFileTest, KeepsWholeMessagesOfATruncatedFile) {
    const std::vector<char> good = joined({sonarData(0, 0, 1), sonarData(0, 1, 1), sonarData(1, 0, 1)});
    const auto path = write(good);
    for (size_t size = good.size() - 1; size > 2; --size) {
        std::filesystem::resize_file(path, size);
        EXPECT_EQ(readFile(path).size(), size < 264 ? 0u : 1u) << size;
        EXPECT_EQ(isNoticed("is cut off"), size % 264 != 0) << size;
    }
}

TEST_F(JsfFileTest, EveryDamagedByteGivesPingsOrOneError) {
    EXPECT_GT(countRefused(joined({sonarData(0, 0, 1), sonarData(0, 1, 1)}), 2, ": byte "), 10u);
}

}  // namespace
}  // namespace insonify::recordings
