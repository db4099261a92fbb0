// Reading of XTF files: files written here, those of other programs, and damaged files.
#include <gmock/gmock.h>

#include "components/recordings/Xtf.hpp"
#include "components/recordings/XtfLayout.hpp"
#include "tests/recordings/RecordedFileTest.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/RecordedBytes.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::recordings {
namespace {

using test::putAt;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
namespace ping_header = xtf::ping_header;
namespace channel_header = xtf::channel_header;

constexpr int64_t first_time = 1'700'000'000'250'000;
constexpr size_t first_ping = xtf::file_header::size;

/** Returns a line in which starboard counts up from 100, port from 1000. */
types::Sonar line(int number, uint32_t bins = 5, double speed_of_sound = 1500) {
    types::Sonar ping = test::makePing(2, bins, 0, first_time + number * 500'000);
    ping.bearings = {types::Angle::fromDeg(-90), types::Angle::fromDeg(90)};
    ping.beam_width = types::Angle::fromDeg(0.5);
    ping.beam_height = types::Angle::fromDeg(50);
    ping.speed_of_sound = static_cast<float>(speed_of_sound);
    for (uint32_t k = 0; k < bins; ++k) {
        ping.bins[k] = static_cast<float>(100 + k);
        ping.bins[bins + k] = static_cast<float>(1000 + k);
    }
    return ping;
}

types::Pose headed(double yaw_deg) {
    types::Pose pose;
    pose.position = {12.5, -3.25, -4};
    pose.orientation = glm::angleAxis(types::radians(yaw_deg), glm::dvec3(0, 0, 1)) *
                       glm::angleAxis(types::radians(10), glm::dvec3(0, 1, 0)) *
                       glm::angleAxis(types::radians(5), glm::dvec3(1, 0, 0));
    return pose;
}

struct XtfFileTest : RecordedFileTest {
    XtfFileTest() : RecordedFileTest("line.xtf") {}
    /** Returns a file of these lines, all at one place. */
    static std::vector<char> getFile(const std::vector<types::Sonar>& lines, XtfSamples samples = XtfSamples::Uint16) {
        const XtfFormat format{samples, 450, "line.xtf"};
        std::vector<char> bytes = xtfHeader(format, lines.front());
        for (const types::Sonar& line : lines) appendXtfPing(format, line, {headed(30), 6.5, 0.5, 0}, bytes);
        return bytes;
    }
};

TEST_F(XtfFileTest, ReadsAnOwnFileBackBinByBin) {
    for (const XtfSamples samples : {XtfSamples::Uint16, XtfSamples::Float32}) {
        const std::vector<types::Sonar> written{line(0), line(1), line(2)};
        const std::vector<RecordedPing> lines = read(getFile(written, samples));
        ASSERT_EQ(lines.size(), 3u);
        for (size_t i = 0; i < 3; ++i) {
            const types::Sonar& ping = lines[i].ping;
            EXPECT_EQ(ping.bins, written[i].bins);
            EXPECT_EQ(ping.time, written[i].time);
            EXPECT_EQ(ping.bin_duration, written[i].bin_duration);
            EXPECT_EQ(ping.speed_of_sound, written[i].speed_of_sound);
            EXPECT_EQ(ping.beam_count, 2u);
            EXPECT_DOUBLE_EQ(ping.bearings[0].deg(), -90);
            EXPECT_DOUBLE_EQ(ping.bearings[1].deg(), 90);
            EXPECT_NEAR(ping.beam_width.deg(), 0.5, 1e-6);
            EXPECT_NEAR(ping.beam_height.deg(), 50, 1e-6);
            EXPECT_EQ(lines[i].frequency_khz, 450);
            EXPECT_TRUE(ping.wellShaped());
        }
        EXPECT_THAT(notices_, testing::ElementsAre(HasSubstr("x = y = 0 of the world is north 0.00 m, east 0.00 m")));
    }
}

TEST_F(XtfFileTest, ReadsAPoseBackInRocksFrames) {
    const RecordedPing read_back = read(getFile({line(0)})).front();
    const types::Pose &pose = read_back.sonar, expected = headed(30);
    EXPECT_NEAR(glm::length(pose.position - expected.position), 0, 1e-6);
    EXPECT_NEAR(std::abs(glm::dot(pose.orientation, expected.orientation)), 1, 1e-12);
    EXPECT_EQ(pose.time.microseconds, first_time);
    EXPECT_EQ(read_back.altitude, 6.5);
}

TEST_F(XtfFileTest, KeepsEveryPingIfSettingsChange) {
    const std::vector<types::Sonar> written{line(0), line(1, 7), line(2, 5, 1450), line(3)};
    const std::vector<RecordedPing> lines = read(getFile(written));
    ASSERT_EQ(lines.size(), 4u);
    for (size_t i = 0; i < lines.size(); ++i) {
        EXPECT_EQ(lines[i].ping.bins, written[i].bins);
        EXPECT_NEAR(lines[i].ping.binStart(lines[i].ping.bin_count), written[i].binStart(written[i].bin_count), 1e-6);
    }
}

TEST_F(XtfFileTest, KeepsRangesIfABinIsNotWholeMicroseconds) {
    types::Sonar fine = line(0);
    std::vector<char> bytes = getFile({fine});
    for (const size_t channel : {0, 1})  // 19.5 us
        putAt(bytes,
              first_ping + ping_header::size + channel * (channel_header::size + 10) + channel_header::slant_range,
              5 * 0.02925f);
    const types::Sonar ping = read(bytes).front().ping;
    EXPECT_NEAR(ping.binStart(5), 5 * 0.02925, 1e-7);
    EXPECT_THAT(notices_, Contains(HasSubstr("bins are 19.50 us long")));
}

TEST_F(XtfFileTest, ConvertsLatitudesAndLongitudesToMetres) {
    std::vector<char> bytes = getFile({line(0), line(1)});
    putAt(bytes, xtf::file_header::nav_units, xtf::file_header::degrees);
    const size_t size = (bytes.size() - first_ping) / 2;
    for (const size_t i : {0, 1}) {
        putAt(bytes, first_ping + i * size + ping_header::sonar, 48.0 + 0.001 * static_cast<double>(i));
        putAt(bytes, first_ping + i * size + ping_header::sonar + 8, -69.0 - 0.001 * static_cast<double>(i));
    }
    const std::vector<RecordedPing> lines = read(bytes);
    EXPECT_EQ(lines[0].sonar.position, glm::dvec3(0, 0, -4));
    EXPECT_NEAR(lines[1].sonar.position.x, 111.20, 0.02) << "a thousandth of a degree of a meridian at 48 N";
    EXPECT_NEAR(lines[1].sonar.position.y, 74.63, 0.02) << "to the west; of the parallel";
    EXPECT_THAT(notices_, Contains(HasSubstr("latitude 48.0000000, longitude -69.0000000 (WGS 84)")));
}

TEST_F(XtfFileTest, StartsProjectedCoordinatesAtTheirFirstPlace) {
    std::vector<char> bytes = getFile({line(0)});
    putAt(bytes, first_ping + ping_header::sonar, 5'367'000.5);
    putAt(bytes, first_ping + ping_header::sonar + 8, 412'000.25);
    EXPECT_EQ(read(bytes).front().sonar.position, glm::dvec3(0, 0, -4));
    EXPECT_THAT(notices_, Contains(HasSubstr("north 5367000.50 m, east 412000.25 m")));
}

TEST_F(XtfFileTest, ReadsOtherWaysToStateTheSame) {
    std::vector<char> bytes = getFile({line(0)});
    const size_t port = first_ping + ping_header::size, starboard = port + channel_header::size + 10;
    putAt(bytes, first_ping + ping_header::sound_speed, 750.0f);  // half of it
    for (const size_t side : {port, starboard})
        putAt(bytes, side + channel_header::slant_range, 0.0f);  // from the duration
    for (const size_t i : {0, 1})
        putAt(bytes, xtf::file_header::channel_infos + i * xtf::channel_info::size + xtf::channel_info::sample_format,
              xtf::channel_info::legacy);
    for (const size_t side : {port, starboard}) putAt(bytes, side + channel_header::weight, int16_t{2});
    const types::Sonar ping = read(bytes).front().ping;
    EXPECT_EQ(ping.speed_of_sound, 1500);
    EXPECT_EQ(ping.bin_duration.microseconds, 100);
    EXPECT_EQ(ping.bins[1], 101 / 4.0f) << "times 2^-2";
}

TEST_F(XtfFileTest, NoticesUnknownAndOmittedData) {
    std::vector<char> bytes = getFile({line(0), line(1), line(2)});
    const size_t size = (bytes.size() - first_ping) / 3;
    putAt(bytes, first_ping + xtf::packet::type, uint8_t{42});
    putAt(bytes, first_ping + size + ping_header::roll, std::numeric_limits<float>::quiet_NaN());
    putAt(bytes, xtf::file_header::channel_infos, uint8_t{3});  // bathymetry in place of port
    const std::vector<RecordedPing> lines = read(bytes);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_FALSE(isUsable(lines[0].sonar));
    EXPECT_TRUE(isUsable(lines[1].sonar));
    EXPECT_EQ(lines[0].ping.beam_count, 1u);
    EXPECT_THAT(notices_, AllOf(Contains(HasSubstr("1 packets of type 42 are omitted")),
                                Contains(HasSubstr("channel 0 is omitted in 2 pings")),
                                Contains(HasSubstr("1 pings have no pose"))));
}

TEST_F(XtfFileTest, RefusesAWrongFileWithItsByte) {
    const std::vector<char> good = getFile({line(0)});
    const auto with = [&](size_t at, auto value) {
        std::vector<char> bytes = good;
        putAt(bytes, at, value);
        return refusal(bytes);
    };
    EXPECT_THAT(with(first_ping, uint16_t{0xFACF}), HasSubstr("byte 1024: is 0xFACF; a packet begins with 0xFACE"));
    EXPECT_THAT(with(first_ping + 10, uint32_t{3}), HasSubstr("byte 1034: the packet has 3 bytes"));
    EXPECT_THAT(with(xtf::file_header::channel_infos + xtf::channel_info::sample_format, uint8_t{1}),
                HasSubstr("byte 330: the samples of channel 0 have format 1"));
}

TEST_F(XtfFileTest, KeepsWholePingsOfATruncatedFile) {
    const std::vector<char> good = getFile({line(0), line(1)});
    const size_t packet = (good.size() - first_ping) / 2;
    const auto path = write(good);
    for (size_t size = good.size() - 1; size > 0; --size) {
        std::filesystem::resize_file(path, size);  // a byte less each time
        if (size < first_ping) {
            EXPECT_THROW(readFile(path), types::ConfigError) << size;
            continue;
        }
        EXPECT_EQ(readFile(path).size(), (size - first_ping) / packet) << size;
        const bool is_whole = (size - first_ping) % packet == 0;
        EXPECT_EQ(isNoticed("is cut off"), !is_whole) << size;
    }
}

TEST_F(XtfFileTest, EveryDamagedByteGivesPingsOrOneError) {
    EXPECT_GT(countRefused(getFile({line(0), line(1)}), 1, ": byte "), 10u) << "others cost a ping";
}

TEST_F(XtfFileTest, ReadsAllPingsOfARealFile) {
    const std::filesystem::path real = test::sharedFile("sonar/xtf/scotsman-iver2.xtf");
    if (!std::filesystem::exists(real)) GTEST_SKIP() << real << " is not there: no real XTF file is tested";
    const auto file = RecordingReader::open(real);
    size_t count = 0, poses = 0, altitudes = 0;
    for (auto line = file->next(); line; line = file->next(), ++count) {
        EXPECT_EQ(line->ping.bin_count, 1024u);
        EXPECT_NEAR(line->ping.binStart(1024), 29.9835, 1e-4);
        EXPECT_EQ(line->frequency_khz, 600);
        poses += isUsable(line->sonar);
        altitudes += line->altitude > 0;
    }
    EXPECT_EQ(count, 461u);
    EXPECT_EQ(poses, 460u) << "the first has none";
    EXPECT_EQ(altitudes, 460u);
    EXPECT_EQ(file->origin(), "latitude 48.4454500, longitude -68.8279350 (WGS 84)");
}

/** Returns the mean of the bins of both sides between two slant ranges [m]. */
double meanBetween(const types::Sonar& ping, double from, double to) {
    double sum = 0, count = 0;
    for (uint32_t beam = 0; beam < 2; ++beam)
        for (uint32_t bin = 0; bin < ping.bin_count; ++bin)
            if (ping.binStart(bin) >= from && ping.binStart(bin) < to) {
                sum += static_cast<double>(ping.bins[beam * ping.bin_count + bin]);
                ++count;
            }
    return sum / count;
}

TEST_F(XtfFileTest, TheWaterColumnOfARealFileIsDarkUpToTheAltitude) {
    const std::filesystem::path real = test::sharedFile("sonar/xtf/scotsman-iver2.xtf");
    if (!std::filesystem::exists(real)) GTEST_SKIP() << real << " is not there: no real XTF file is tested";
    const auto file = RecordingReader::open(real);
    constexpr double pulse_end = 1;  // [m]
    size_t checked = 0;
    for (auto line = file->next(); line; line = file->next()) {
        const double altitude = line->altitude;
        if (altitude == 0) continue;
        const types::Sonar& ping = line->ping;
        const double water = meanBetween(ping, pulse_end, altitude);
        EXPECT_GT(meanBetween(ping, 1.3 * altitude, 1.8 * altitude), 10 * water) << "the bottom at " << altitude;
        double first = pulse_end;
        while (meanBetween(ping, first, first + 0.15) < 4 * water) first += 0.1;
        const glm::dvec3 ahead = line->sonar.orientation * glm::dvec3(1, 0, 0);
        const double to_floor = altitude / std::hypot(ahead.x, ahead.y);  // in the pitching plane of the beams
        EXPECT_GT(first, 0.95 * to_floor);
        EXPECT_LT(first, 1.25 * to_floor);
        ++checked;
    }
    EXPECT_EQ(checked, 460u);
}

}  // namespace
}  // namespace insonify::recordings
