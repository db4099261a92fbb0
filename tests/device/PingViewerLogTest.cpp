// Sensor logs of Ping Viewer: made here at random from the messages of both devices, damaged, and made by the maker's
// Python package.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "components/device/PingViewerLog.hpp"
#include "tests/support/Draw.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/PingViewerRecording.hpp"
#include "tests/support/Python.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::device {
namespace {

using namespace insonify::test;
using recordings::RecordedPing, recordings::RecordedShape;
using testing::Contains, testing::HasSubstr, testing::IsEmpty, testing::SizeIs;

Bytes randomEchoes(Draw& draw, size_t count) {
    Bytes data(count);
    for (uint8_t& code : data) code = static_cast<uint8_t>(draw.upTo(256));
    return data;
}

Ping360AutoDeviceData makeScan(Draw& draw) {
    Ping360AutoDeviceData data;
    data.angle = static_cast<uint16_t>(draw.upTo(400));
    data.acoustics = {static_cast<uint8_t>(draw.upTo(3)), 32, static_cast<uint16_t>(80 + draw.upTo(39'921)),
                      static_cast<uint16_t>(500 + draw.upTo(501)), static_cast<uint16_t>(200 + draw.upTo(1001))};
    data.data = randomEchoes(draw, data.acoustics.samples);
    return data;
}

Ping1dProfile makeProfile(Draw& draw) {
    Ping1dProfile profile;
    profile.measurement = {static_cast<uint32_t>(500 + draw.upTo(60'000)),
                           static_cast<uint16_t>(draw.upTo(101)),
                           100,
                           static_cast<uint32_t>(draw.upTo(1'000'000)),
                           static_cast<uint32_t>(draw.upTo(20'000)),
                           static_cast<uint32_t>(1000 + draw.upTo(60'000)),
                           static_cast<uint32_t>(draw.upTo(7))};
    profile.data = randomEchoes(draw, 200);
    return profile;
}

/** Returns whether the bins behind `first` are the echoes, and those before it 0. */
bool holds(const types::Sonar& ping, size_t first, const Bytes& echoes) {
    std::vector<float> expected(first, 0);
    expected.insert(expected.end(), echoes.begin(), echoes.end());
    return ping.bins == expected;
}

struct PingViewerLogTest : testing::Test {
    std::vector<RecordedPing> read(const std::vector<RecordedBytes>& parts, const std::string& name = "dive.bin") {
        writeBytes(folder_ / name, joinedBytes(parts));
        return readFile(folder_ / name);
    }
    std::vector<RecordedPing> readFile(const std::filesystem::path& file) {
        PingViewerReader reader(file);
        shape_ = reader.shape();
        std::vector<RecordedPing> all;
        try {
            for (auto ping = reader.next(); ping; ping = reader.next()) all.push_back(std::move(*ping));
        } catch (const types::ConfigError& error) {
            EXPECT_THAT(error.what(), HasSubstr("holds no ping of a Ping360 or a Ping1D"));
        }
        notices_ = reader.notices();
        return all;
    }
    bool isNoticed(const std::string& text) const {
        return std::ranges::any_of(notices_, [&](const auto& notice) { return notice.find(text) != notice.npos; });
    }

    const Folder folder_;
    std::vector<std::string> notices_;
    RecordedShape shape_{};
};

/** Random messages in one record each, or cut at random places into records, with texts of either type. */
TEST_F(PingViewerLogTest, ScansAreReadBackHoweverTheirBytesArrive) {
    const Seeds seeds(40);
    for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
        SCOPED_TRACE(seed);
        Draw draw(seed);
        const auto texts = draw.once(3) ? PingViewerTexts::Narrow : PingViewerTexts::Wide;
        const bool is_cut = draw.once(2);
        std::vector<RecordedBytes> parts{pingViewerHeader(texts)};
        std::vector<Ping360AutoDeviceData> sent;
        std::vector<double> times;
        Bytes line;
        for (double seconds = draw.between(0, 5); sent.size() < 8; seconds += draw.between(0.01, 3)) {
            const Ping360AutoDeviceData data = makeScan(draw);
            const Bytes bytes = draw.once(2) ? pingBytes(data, 2)
                                             : pingBytes(Ping360DeviceData{1, data.angle, data.acoustics, data.data});
            line.insert(line.end(), bytes.begin(), bytes.end());
            const size_t whole = line.size();
            const size_t now = is_cut ? static_cast<size_t>(draw.upTo(static_cast<int>(whole))) : whole;
            const std::string time = pingViewerTime(seconds), later = pingViewerTime(seconds + 0.004);
            parts.push_back(pingViewerRecord(time, {line.begin(), line.begin() + static_cast<ptrdiff_t>(now)}, texts));
            parts.push_back(pingViewerRecord(later, {line.begin() + static_cast<ptrdiff_t>(now), line.end()}, texts));
            line.clear();
            sent.push_back(data);
            times.push_back(now == whole ? seconds : seconds + 0.004);
        }
        const auto pings = read(parts);
        EXPECT_EQ(shape_, RecordedShape::Scan);
        ASSERT_THAT(pings, SizeIs(sent.size())) << testing::PrintToString(notices_);
        for (size_t i = 0; i < pings.size(); ++i) {
            const types::Sonar& ping = pings[i].ping;
            const Ping360Acoustics& acoustics = sent[i].acoustics;
            EXPECT_TRUE(holds(ping, 0, sent[i].data));
            EXPECT_NO_THROW(ping.validate());
            EXPECT_NEAR(ping.time.seconds(), 1 + times[i], 0.0006);
            EXPECT_NEAR(std::remainder(ping.bearings.at(0).deg() - 0.9 * (200 - sent[i].angle), 360), 0, 1e-9);
            const double range = acoustics.samples * acoustics.sample_period * 25e-9 * 1500 / 2;
            EXPECT_NEAR(pings[i].range, range, 1e-7 * range);
            EXPECT_EQ(pings[i].frequency_khz, acoustics.frequency_khz);
            EXPECT_EQ(pings[i].gain_db, 10 * acoustics.gain);
            EXPECT_EQ(pings[i].max_code, 255);
        }
        EXPECT_FALSE(isNoticed("omitted"));
        EXPECT_TRUE(isNoticed("the log states no speed of sound: ranges are those at 1500 m/s"));
    }
}

TEST_F(PingViewerLogTest, ProfilesAreReadBackByTheReportedSpeedOfSound) {
    const Seeds seeds(40);
    for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
        SCOPED_TRACE(seed);
        Draw draw(seed);
        const double speed = draw.once(2) ? 1500 : std::round(draw.between(1400, 1600));
        std::vector<RecordedBytes> parts{pingViewerHeader()};
        const Ping1dSpeedOfSound reported{static_cast<uint32_t>(1000 * speed)};
        if (speed != 1500) parts.push_back(pingViewerRecord("00:00:00.100", pingBytes(reported)));
        std::vector<Ping1dProfile> sent;
        for (int i = 0; i < 5; ++i) {
            sent.push_back(makeProfile(draw));
            parts.push_back(pingViewerRecord(pingViewerTime(1 + i), pingBytes(sent.back(), 1)));
        }
        const auto pings = read(parts);
        EXPECT_EQ(shape_, RecordedShape::Sounder);
        ASSERT_THAT(pings, SizeIs(sent.size()));
        for (size_t i = 0; i < pings.size(); ++i) {
            const Ping1dMeasurement& made = sent[i].measurement;
            const double sample = made.length / 1e3 / 200, start = made.start / 1e3;
            EXPECT_NEAR(pings[i].window_start, start, sample / 2 + 1e-9);
            EXPECT_NEAR(pings[i].range, start + made.length / 1e3, sample / 2 + 1e-6 * start);
            EXPECT_TRUE(holds(pings[i].ping, static_cast<size_t>(std::lround(start / sample)), sent[i].data));
            EXPECT_EQ(pings[i].altitude, made.confidence > 0 ? made.distance / 1e3 : 0);
            EXPECT_EQ(pings[i].number, made.ping_number);
            EXPECT_EQ(pings[i].ping.bearings.at(0).rad, 0);
            EXPECT_EQ(pings[i].frequency_khz, 0) << "is not stated";
            EXPECT_NEAR(pings[i].speed_of_sound, speed, 1e-3);
            EXPECT_NEAR(pings[i].gain_db, ping1dGainDb(made.gain), 1e-12);
        }
        EXPECT_EQ(isNoticed("1 messages 1203 are omitted"), speed != 1500);
    }
}

TEST_F(PingViewerLogTest, TimesAreSinceTheDateInTheNameAndGoOnAfterMidnight) {
    Draw draw(1);
    const Bytes scan = pingBytes(makeScan(draw));
    const std::vector<RecordedBytes> parts{pingViewerHeader(),
                                           pingViewerRecord("00:00:03.250", scan),
                                           pingViewerRecord("13:00:00.000", scan),
                                           pingViewerRecord("23:59:59.999", scan),
                                           pingViewerRecord("00:00:00.001", scan),
                                           pingViewerRecord("", scan),
                                           pingViewerRecord("00:00:00.501", scan),
                                           pingViewerRecord("23:00:00.000", scan),
                                           pingViewerRecord("01:00:00.000", scan)};
    const double since_begin[] = {3.25, 46800, 86399.999, 86400.001, 86400.001, 86400.501, 169200, 176400};
    const std::map<std::string, double> begins = {{"20240229-235959500.bin", 1709251199.5},
                                                  {"dive.bin", 1},
                                                  {"20240230-235959500.bin", 1},
                                                  {"20240229-245959500.bin", 1}};
    for (const auto& [name, begin] : begins) {
        const auto pings = read(parts, name);
        ASSERT_THAT(pings, SizeIs(std::size(since_begin)));
        for (size_t i = 0; i < pings.size(); ++i)
            EXPECT_NEAR(pings[i].ping.time.seconds(), begin + since_begin[i], 1e-6) << name << i;
        EXPECT_EQ(isNoticed("the beginning of the log is that in its name, read as UTC"), begin != 1) << name;
        EXPECT_EQ(isNoticed("it begins 1 s after 1970"), begin == 1) << name;
        EXPECT_TRUE(isNoticed("1 records have no time, as after 24 hours, and get that of the record before"));
    }
}

TEST_F(PingViewerLogTest, OtherAndOddMessagesAreOmittedAndCounted) {
    Draw draw(2);
    Ping360AutoDeviceData odd = makeScan(draw), silent = makeScan(draw);
    odd.angle = 400;
    silent.data.clear();
    Bytes damaged = pingBytes(makeScan(draw));
    damaged[30] ^= 0x10;
    const Bytes good = pingBytes(makeScan(draw)), noise{1, 'B', 2, 3};
    std::vector<RecordedBytes> parts{pingViewerHeader()};
    size_t second = 0;
    for (const Bytes& bytes : {pingBytes(PingText{"hello"}), damaged, good, pingBytes(odd), pingBytes(silent), noise,
                               pingBytes(makeProfile(draw)), damaged, good})
        parts.push_back(pingViewerRecord(pingViewerTime(static_cast<double>(++second)), bytes));
    EXPECT_THAT(read(parts), SizeIs(2));
    EXPECT_TRUE(isNoticed("2 messages have a wrong checksum and are omitted; the first: in the record at byte "));
    EXPECT_TRUE(isNoticed("1 messages contradict themselves and are omitted; the first: in the record at byte "));
    EXPECT_TRUE(isNoticed("the angle is 400, at most 399"));
    EXPECT_TRUE(isNoticed("1 messages have no echoes and are omitted"));
    EXPECT_TRUE(isNoticed("4 bytes between messages are omitted"));
    EXPECT_TRUE(isNoticed("1 messages 3 are omitted"));
    EXPECT_TRUE(isNoticed("1 messages 1300 are omitted")) << "those of the other device";
    Ping1dProfile no_length = makeProfile(draw), far = makeProfile(draw);
    no_length.measurement.length = 0;
    far.measurement.start = 4'000'000'000;
    EXPECT_THAT(read({pingViewerHeader(), pingViewerRecord("00:00:01.000", pingBytes(no_length)),
                      pingViewerRecord("00:00:02.000", pingBytes(far)),
                      pingViewerRecord("00:00:03.000", pingBytes(makeProfile(draw)))}),
                SizeIs(1));
    EXPECT_TRUE(isNoticed("2 messages contradict themselves")) << testing::PrintToString(notices_);
}

TEST_F(PingViewerLogTest, ATruncatedFileHasTheWholeRecordsBefore) {
    Draw draw(3);
    std::vector<RecordedBytes> parts{pingViewerHeader()};
    for (int i = 0; i < 3; ++i) {
        Ping360AutoDeviceData data = makeScan(draw);
        data.data.resize(20);
        parts.push_back(pingViewerRecord(pingViewerTime(i), pingBytes(data)));
    }
    const RecordedBytes good = joinedBytes(parts);
    for (size_t size = 1; size <= good.size(); ++size) {
        const RecordedBytes cut(good.begin(), good.begin() + static_cast<ptrdiff_t>(size));
        size_t whole = 0, end = parts[0].size();
        bool is_between = size == end;
        for (size_t i = 1; i < parts.size(); ++i) {
            end += parts[i].size();
            whole += size >= end ? 1 : 0;
            is_between = is_between || size == end;
        }
        if (size < parts[0].size()) {
            EXPECT_THAT(computeError<types::ConfigError>([&] { read({cut}); }), HasSubstr("dive.bin: byte ")) << size;
            continue;
        }
        EXPECT_THAT(read({cut}), SizeIs(whole)) << size;
        EXPECT_EQ(isNoticed("1 records are cut off by the end of the file; the first: byte "), !is_between) << size;
    }
}

TEST_F(PingViewerLogTest, DamageCostsOnlyTheDamagedRecords) {
    Draw draw(4);
    std::vector<RecordedBytes> parts{pingViewerHeader()};
    for (int i = 0; i < 6; ++i) {
        Ping360AutoDeviceData data = makeScan(draw);
        data.data.resize(20);
        parts.push_back(pingViewerRecord(pingViewerTime(i), pingBytes(data)));
    }
    const RecordedBytes good = joinedBytes(parts);
    for (size_t at = parts[0].size(); at < good.size(); ++at) {
        RecordedBytes bytes = good;
        bytes[at] = static_cast<char>(bytes[at] ^ (at % 2 == 0 ? 0xFF : 1 << at / 2 % 8));
        const auto pings = read({bytes});
        EXPECT_GE(pings.size(), 5u) << at;
        for (const RecordedPing& ping : pings) EXPECT_NO_THROW(ping.ping.validate()) << at;
    }
    RecordedBytes noisy = joinedBytes({parts[0], parts[1], RecordedBytes(100'000, 24), parts[2], parts[3]});
    EXPECT_THAT(read({noisy}), SizeIs(3));
    EXPECT_TRUE(isNoticed("1 places have bytes that are no record, 100000 in all, which are omitted; the first: byte " +
                          std::to_string(parts[0].size() + parts[1].size())))
        << testing::PrintToString(notices_);
}

TEST_F(PingViewerLogTest, AFileThatIsNoLogIsOneErrorWithItsPlace) {
    const auto refusal = [&](const RecordedBytes& bytes) {
        return computeError<types::ConfigError>([&] { read({bytes}); });
    };
    EXPECT_THAT(refusal(pingViewerText("PingViewer other file", PingViewerTexts::Wide)),
                HasSubstr("dive.bin: byte 0: does not begin with the text 'PingViewer sensor log file', nor as another "
                          "recording does; may be a .xtf, "));
    EXPECT_THAT(refusal(pingViewerHeader(PingViewerTexts::Wide, 2)),
                HasSubstr("dive.bin: byte 56: is version 2 of the log; 1 is read"));
    EXPECT_THAT(refusal(RecordedBytes(100)), HasSubstr("dive.bin: byte 0: does not begin"));
    EXPECT_THAT(refusal(bigEndian(1'000'000)), HasSubstr("dive.bin: byte 0: is no text"));
    EXPECT_THAT(read({pingViewerHeader()}), IsEmpty());
    PingViewerReader empty(folder_ / "dive.bin");
    EXPECT_THAT(computeError<types::ConfigError>([&] { empty.next(); }),
                HasSubstr("holds no ping of a Ping360 or a Ping1D"));
}

TEST_F(PingViewerLogTest, ALogOfTheMakersMessagesIsRead) {
    if (!pythonHas("brping"))
        GTEST_SKIP() << "SKIPPED: the Python package bluerobotics-ping is missing; scripts/setup installs it";
    const std::string said =
        pythonSays(sourceFile("tests/device/write_ping_log.py ") + folder_.path().string(), folder_ / "answer");
    const auto expected = nlohmann::json::parse(said, nullptr, false);
    ASSERT_FALSE(expected.is_discarded()) << said;
    for (const auto& log : expected) {
        const auto pings = readFile(folder_ / log["file"].get<std::string>());
        ASSERT_THAT(pings, SizeIs(log["pings"].size())) << log["file"];
        for (size_t i = 0; i < pings.size(); ++i) {
            const auto& made = log["pings"][i];
            EXPECT_TRUE(holds(pings[i].ping, made["first"], made["data"].get<Bytes>())) << log["file"] << i;
            EXPECT_NEAR(pings[i].ping.time.seconds(), made["time"], 1e-5);
            EXPECT_NEAR(pings[i].range, made["range"], 1e-6);
            EXPECT_NEAR(std::remainder(pings[i].ping.bearings[0].deg() - made["bearing_deg"].get<double>(), 360), 0,
                        1e-9);
        }
    }
}

}  // namespace
}  // namespace insonify::device
