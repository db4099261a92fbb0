// Recordings of an Oculus: written files are read byte for byte, and damage costs only the damaged items.
#include <gmock/gmock.h>
#include <zlib.h>

#include <algorithm>

#include "components/device/OculusPing.hpp"
#include "components/device/OculusRecording.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/OculusMessage.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::device {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Bytes pingBytes(uint32_t number) { return test::OculusMessage{.number = number}.bytes(); }

/** Returns the messages of the three real pings; none without the recording. */
std::vector<Bytes> realPings() {
    const std::vector<char> bytes = insonify::toBytes(test::sharedFile("sonar/oculus/three_pings_8bit.raw"));
    OculusFramer framer;
    framer.add({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
    std::vector<Bytes> messages;
    for (Bytes message = framer.next(); !message.empty(); message = framer.next()) messages.push_back(message);
    return messages;
}

struct OculusRecordingTest : ::testing::Test {
    /** Pings 1, 2, 3, at intervals of a tenth of a second. */
    void record() const {
        OculusRecorder recorder(file_, {.time = 1700000000});
        for (uint32_t number = 1; number <= 3; ++number) recorder.write(1700000000 + 0.1 * number, pingBytes(number));
    }
    std::vector<uint32_t> numbers(std::string* diagnostic = nullptr) const {
        OculusPings pings(file_);
        std::vector<uint32_t> found;
        while (const auto recorded = pings.next()) found.push_back(recorded->ping.number);
        if (diagnostic) *diagnostic = pings.diagnostic();
        return found;
    }
    void damage(size_t at, std::initializer_list<char> by) const {
        std::vector<char> bytes = insonify::toBytes(file_);
        std::ranges::copy(by, bytes.begin() + static_cast<std::ptrdiff_t>(at));
        writeBytes(file_, bytes);
    }

    const Folder folder_;
    const std::filesystem::path file_ = folder_ / "dive.oculus";
};

TEST_F(OculusRecordingTest, FieldsAreAtTheOffsetsOfOtherReaders) {
    record();
    const std::vector<char> chars = insonify::toBytes(file_);
    const Bytes bytes(chars.begin(), chars.end());
    EXPECT_EQ(read<uint32_t>(bytes, 0), 0x11223344u);
    EXPECT_EQ(read<uint32_t>(bytes, 4), 48u);
    EXPECT_EQ(std::string(bytes.begin() + 8, bytes.begin() + 14), "Oculus");
    EXPECT_EQ(read<double>(bytes, 40), 1700000000);
    EXPECT_EQ(read<uint32_t>(bytes, 48), 0xaabbccddu);
    EXPECT_EQ(read<uint32_t>(bytes, 52), 40u);
    EXPECT_EQ(read<uint16_t>(bytes, 56), 10);
    EXPECT_EQ(read<double>(bytes, 64), 1700000000.1);
    EXPECT_EQ(read<uint16_t>(bytes, 72), 0);
    EXPECT_EQ(read<uint32_t>(bytes, 76), pingBytes(1).size());
    EXPECT_EQ(read<uint32_t>(bytes, 80), pingBytes(1).size());
    EXPECT_EQ(read<uint16_t>(bytes, 88), 0x4F53) << "and the message itself";
}

TEST_F(OculusRecordingTest, ReadItemsAreWrittenByteForByte) {
    record();
    OculusRecording recording(file_);
    std::vector<OculusItem> items;
    while (auto item = recording.next()) items.push_back(*item);
    ASSERT_THAT(items, SizeIs(3));
    items[1].type = 1010;  // of other programs, and with bytes where nothing is defined
    items[1].unused_a = 7;
    const auto copy = [&](const std::filesystem::path& to) {
        OculusRecorder recorder(to, recording.header());
        for (const OculusItem& item : items) recorder.write(item);
    };
    copy(folder_ / "copy.oculus");
    OculusRecording again(folder_ / "copy.oculus");
    for (OculusItem& item : items) item = again.next().value();
    copy(folder_ / "again.oculus");
    EXPECT_EQ(insonify::toBytes(folder_ / "again.oculus"), insonify::toBytes(folder_ / "copy.oculus"));
    EXPECT_EQ(items[1].unused_a, 7u);
    EXPECT_FALSE(again.next());
    EXPECT_THAT(again.diagnostic(), IsEmpty());
}

TEST_F(OculusRecordingTest, RealPingsAreRecordedAndPlayedByteForByte) {
    const std::vector<Bytes> messages = realPings();
    if (messages.empty()) GTEST_SKIP() << "three_pings_8bit.raw is missing: no recording of a device is tested";
    {
        OculusRecorder recorder(file_, {});
        for (size_t i = 0; i < messages.size(); ++i) recorder.write(100 + 0.1 * static_cast<double>(i), messages[i]);
    }
    OculusPings pings(file_);
    for (size_t i = 0; i < messages.size(); ++i) {
        const auto recorded = pings.next();
        ASSERT_TRUE(recorded);
        EXPECT_DOUBLE_EQ(recorded->time, 100 + 0.1 * static_cast<double>(i));
        EXPECT_EQ(toBytes(recorded->ping), messages[i]);
    }
    EXPECT_FALSE(pings.next());
    size_t read = 0;
    for (OculusReader reader(file_); reader.next();) ++read;
    EXPECT_EQ(read, 3u);
}

TEST_F(OculusRecordingTest, ACaptureIsTimedByTheDevicesClock) {
    if (realPings().empty()) GTEST_SKIP() << "three_pings_8bit.raw is missing: no recording of a device is tested";
    OculusPings pings(test::sharedFile("sonar/oculus/three_pings_8bit.raw"));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(pings.next().value().time, 0.1 * i, 1e-4);
    EXPECT_FALSE(pings.next());
}

TEST_F(OculusRecordingTest, TheTimeOfACaptureNeverRunsBackwards) {
    std::vector<char> all;
    for (const uint32_t ticks : {4294900000u, 61'432'704u, 123'932'704u}) {
        OculusResult ping = oculusResult(pingBytes(1)).value();
        ping.start_ticks = ticks;
        const Bytes bytes = toBytes(ping);
        all.insert(all.end(), bytes.begin(), bytes.end());
    }
    for (const double start : {50.0, 50.5, 3.0, std::nan("")}) {
        OculusResult ping = oculusResult(test::OculusMessage{.version = 2}.bytes()).value();
        ping.start_s = start;
        const Bytes bytes = toBytes(ping);
        all.insert(all.end(), bytes.begin(), bytes.end());
    }
    writeBytes(folder_ / "clock.raw", all);
    OculusPings pings(folder_ / "clock.raw");
    std::vector<double> times;
    while (const auto recorded = pings.next()) times.push_back(recorded->time);
    ASSERT_THAT(times, SizeIs(7));
    EXPECT_NEAR(times[1], 0.0984, 1e-3);
    EXPECT_NEAR(times[2], times[1] + 0.1, 1e-6);
    EXPECT_NEAR(times[4] - times[3], 0.5, 1e-9);
    EXPECT_EQ(times[5], times[4]);
    EXPECT_EQ(times[6], times[4]);
}

TEST_F(OculusRecordingTest, UnpacksCompressedItems) {
    const Bytes message = pingBytes(5);
    uLongf size = compressBound(message.size());
    Bytes packed(4 + size);
    ASSERT_EQ(compress(packed.data() + 4, &size, message.data(), message.size()), Z_OK);
    packed.resize(4 + size);
    OculusItem item{.compression = 1, .original_size = static_cast<uint32_t>(message.size()), .payload = packed};
    EXPECT_EQ(item.content(), message);
    {
        OculusRecorder recorder(file_, {});
        recorder.write(item);
        item.payload[6] ^= 0xFF;
        EXPECT_FALSE(item.content());
        recorder.write(item);
        recorder.write(0, pingBytes(6));
    }
    EXPECT_THAT(numbers(), ElementsAre(5, 6)) << "damaged items are skipped";
    item.original_size = 0xFFFFFFFF;
    EXPECT_FALSE(item.content());
    item.payload.clear();
    EXPECT_FALSE(item.content());
}

TEST_F(OculusRecordingTest, DamageCostsOnlyTheDamagedItems) {
    record();
    const size_t item = 40 + pingBytes(1).size();
    std::string diagnostic;
    EXPECT_THAT(numbers(&diagnostic), ElementsAre(1, 2, 3));
    EXPECT_THAT(diagnostic, IsEmpty());
    damage(48 + item, {0});  // the mark of the second item
    EXPECT_THAT(numbers(&diagnostic), ElementsAre(1, 3));
    EXPECT_THAT(diagnostic, HasSubstr("no item begins at byte " + std::to_string(48 + item)));
    damage(48 + 32, {-1, -1, -1, 127});  // the size of the first
    EXPECT_THAT(numbers(), ElementsAre(3));
    record();
    damage(48 + 40 + 114, {9});  // the size of an image
    EXPECT_THAT(numbers(&diagnostic), ElementsAre(2, 3));
    EXPECT_THAT(diagnostic, HasSubstr("ping 1 has an image of 9 bytes"));
    record();
    const std::vector<char> whole = insonify::toBytes(file_);
    for (size_t size = 48; size < whole.size(); size += 13) {
        writeBytes(file_, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
        EXPECT_EQ(numbers().size(), (size - 48) / item) << size;
    }
}

TEST_F(OculusRecordingTest, AnIncompleteMessageAtTheEndOfACaptureCostsNoOther) {
    std::vector<char> all;
    for (uint32_t number = 1; number <= 4; ++number) {
        const Bytes bytes = pingBytes(number);
        all.insert(all.end(), bytes.begin(), bytes.end());
    }
    const size_t size = pingBytes(1).size();
    std::string diagnostic;
    writeBytes(file_, all);
    EXPECT_THAT(numbers(&diagnostic), ElementsAre(1, 2, 3, 4));
    EXPECT_THAT(diagnostic, IsEmpty());
    damage(size + 10, {0, 0, 1, 0});  // the size of the second, far below 2^28
    EXPECT_THAT(numbers(&diagnostic), ElementsAre(1, 3, 4));
    EXPECT_EQ(diagnostic, "the message at byte " + std::to_string(size) + " is longer than the file");
    all.resize(3 * size + 20);
    writeBytes(file_, all);
    EXPECT_THAT(numbers(&diagnostic), ElementsAre(1, 2, 3));
    EXPECT_THAT(diagnostic, HasSubstr("the message at byte " + std::to_string(3 * size)));
}

TEST_F(OculusRecordingTest, RefusesOtherFiles) {
    const auto makeMessage = [](const auto& make) -> std::string {
        return test::computeError<types::ConfigError>([&] { make(); });
    };
    writeBytes(file_, std::vector<char>(100, 'S'));
    EXPECT_THAT(makeMessage([&] { OculusRecording recording(file_); }), HasSubstr("does not begin as a recording"));
    EXPECT_THAT(makeMessage([&] { OculusRecording recording(folder_ / "no"); }), HasSubstr("cannot be read"));
    EXPECT_THAT(makeMessage([&] { OculusPings pings(folder_.path()); }), HasSubstr("cannot be read"));
    EXPECT_THAT(makeMessage([&] { OculusRecorder recorder(folder_ / "no/a.oculus", {}); }),
                HasSubstr("cannot be written"));
    EXPECT_THAT(numbers(), IsEmpty());
}

}  // namespace
}  // namespace insonify::device
