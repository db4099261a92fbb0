// The table of the formats of recordings, and what their readers share.
#include "components/recordings/Xtf.hpp"
#include "tests/recordings/RecordedFileTest.hpp"
#include "tests/support/Pings.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::recordings {
namespace {

using testing::AllOf, testing::ElementsAre, testing::HasSubstr, testing::SizeIs;

/** Returns an XTF file of lines at whole seconds. */
RecordedBytes xtfLines(int count) {
    const auto line = [](int i) {
        types::Sonar ping = test::makePing(2, 5, 0, 1'700'000'000'000'000 + i * 1'000'000);
        ping.bearings = {types::Angle::fromDeg(-90), types::Angle::fromDeg(90)};
        return ping;
    };
    RecordedBytes bytes = xtfHeader({.name = "line.xtf"}, line(0));
    for (int i = 0; i < count; ++i) appendXtfPing({}, line(i), {}, bytes);
    return bytes;
}

struct RecordingReaderTest : RecordedFileTest {
    RecordingReaderTest() : RecordedFileTest("line.xtf") {}
};

TEST_F(RecordingReaderTest, EveryFormatHasItsOwnEndingAndSignature) {
    const auto formats = recordingFormats();
    for (const RecordingFormat& format : formats) {
        EXPECT_NE(format.open == nullptr, format.component == nullptr) << format.name << " has one reader";
        EXPECT_EQ(format.ending, types::lowered(std::string(format.ending)));
        EXPECT_EQ(format.ending.empty(), format.signature.empty()) << format.name;
        for (const RecordingFormat& other : formats.first(formats.size() - 1))
            EXPECT_EQ(&other == &format, format.signature.starts_with(other.signature)) << format.name << other.name;
        if (format.ending.empty()) continue;
        EXPECT_THAT(recordingEndings(), HasSubstr(std::string(format.ending)));
        std::string upper(format.ending);
        for (char& letter : upper) letter = static_cast<char>(std::toupper(letter));
        for (const std::string& file : {"a" + std::string(format.ending), "a.b" + upper})
            EXPECT_EQ(findRecordingFormat(file), &format) << file;
    }
    EXPECT_TRUE(formats.back().signature.empty()) << "tried for files of no other format";
    EXPECT_EQ(findRecordingFormat("a.log"), nullptr);
    EXPECT_EQ(findRecordingFormat("a"), nullptr);
    EXPECT_EQ(findRecordingFormat("xtf"), nullptr);
}

TEST_F(RecordingReaderTest, AFileThatCannotBeReadIsOneErrorWithTheRemedy) {
    const auto getRefusal = [&](const std::filesystem::path& file) {
        return test::computeError<types::ConfigError>([&] { RecordingReader::open(file); });
    };
    EXPECT_THAT(getRefusal(folder_ / "no.xtf"),
                AllOf(HasSubstr("no.xtf: does not exist; may be a "), HasSubstr(recordingEndings() + " file")));
    EXPECT_THAT(getRefusal(folder_.path()), HasSubstr(": is a folder; give a recording in it"));
    EXPECT_THAT(getRefusal(write({})), HasSubstr("line.xtf: is empty; may be a " + recordingEndings()));
}

TEST_F(RecordingReaderTest, WhereALogIsWantedARecordingIsAnErrorWithTheCommandThatImportsIt) {
    for (const RecordingFormat& format : recordingFormats()) {
        const std::string refusal =
            test::computeError<types::ConfigError>([&] { refuseRecording("a" + std::string(format.ending)); });
        EXPECT_EQ(
            refusal.find("a recording of " + std::string(format.device) + "; `insonify log import`") != refusal.npos,
            !format.ending.empty())
            << refusal;
    }
    EXPECT_NO_THROW(refuseRecording("a.0.log"));
}

TEST_F(RecordingReaderTest, TheContentDecidesAndNotTheEnding) {
    for (const char* name : {"line.XTF", "line.aris", "line", "line.txt"}) {
        writeBytes(folder_ / name, xtfLines(2));
        EXPECT_STREQ(RecordingReader::open(folder_ / name)->format().name, "XTF");
        EXPECT_THAT(readFile(folder_ / name), SizeIs(2)) << name;
    }
}

TEST_F(RecordingReaderTest, PingsAreNumberedAndTimedAndHaveTheirRange) {
    const auto pings = read(xtfLines(3));
    ASSERT_THAT(pings, SizeIs(3));
    for (size_t i = 0; i < pings.size(); ++i) {
        EXPECT_DOUBLE_EQ(pings[i].since_first, static_cast<double>(i));
        EXPECT_DOUBLE_EQ(pings[i].range, pings[i].ping.binStart(5));
        EXPECT_EQ(pings[i].speed_of_sound, static_cast<double>(pings[i].ping.speed_of_sound));
    }
}

TEST_F(RecordingReaderTest, AFileWithoutAPingIsAnErrorAndDamageAfterOneANotice) {
    const auto reader = RecordingReader::open(write(xtfLines(0)));
    EXPECT_THAT(test::computeError<types::ConfigError>([&] { reader->next(); }),
                HasSubstr("line.xtf: holds no ping of a side-scan"));
    RecordedBytes bytes = xtfLines(3);
    const size_t packet = (bytes.size() - 1024) / 3;
    bytes[1024 + packet] = 7;
    EXPECT_THAT(read(bytes), SizeIs(1));
    EXPECT_THAT(notices_.front(), AllOf(HasSubstr(std::to_string(1024 + packet)),
                                        HasSubstr("a packet begins with 0xFACE; only the 1 earlier pings are read")));
}

TEST_F(RecordingReaderTest, AnyBytesBehindASignatureArePingsOrOneError) {
    std::mt19937 random(11);
    for (const RecordingFormat& format : recordingFormats()) {
        if (!format.open) continue;
        for (int round = 0; round < 60; ++round) {
            RecordedBytes bytes(format.signature.begin(), format.signature.end());
            for (const char sample : randomSamples(random() % 3000, random)) bytes.push_back(sample);
            try {
                for (const RecordedPing& ping : read(bytes)) EXPECT_NO_THROW(ping.ping.validate());
            } catch (const types::ConfigError& error) {
                EXPECT_THAT(error.diagnostics(), SizeIs(1));
                EXPECT_THAT(error.what(), HasSubstr("line.xtf: ")) << format.name;
            }
        }
    }
}

}  // namespace
}  // namespace insonify::recordings
