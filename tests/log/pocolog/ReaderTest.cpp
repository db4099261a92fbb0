#include <gmock/gmock.h>
#include <zlib.h>

#include "components/log/pocolog/BlockFile.hpp"
#include "components/log/pocolog/Reader.hpp"
#include "components/log/pocolog/Wire.hpp"
#include "components/log/pocolog/Writer.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::log::pocolog {
namespace {

using testing::HasSubstr;

void append(std::vector<char>& bytes, const auto& value) {
    const char* data = reinterpret_cast<const char*>(&value);
    bytes.insert(bytes.end(), data, data + sizeof value);
}

/** A log written by hand: zero padding, plain metadata, any flags, one stream of any type. */
std::vector<char> foreignLog(const std::string& type, uint32_t flags = 0) {
    std::vector<char> bytes(magic.begin(), magic.end());
    append(bytes, format_version);
    append(bytes, flags);
    std::vector<char> payload{1};
    for (const std::string& text :
         {std::string("other.port"), type, std::string("<typelib/>"), std::string("a: b\n")}) {
        append(payload, static_cast<uint32_t>(text.size()));
        payload.insert(payload.end(), text.begin(), text.end());
    }
    append(bytes, BlockHeader{BlockType::Stream, 0, 0, static_cast<uint32_t>(payload.size())});
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    return bytes;
}

void appendSample(std::vector<char>& bytes, const std::vector<char>& data, bool compressed) {
    append(bytes, BlockHeader{BlockType::Data, 0, 0, static_cast<uint32_t>(data_header_size + data.size())});
    const DataHeader header{1, 0, 1, 0, static_cast<uint32_t>(data.size()), compressed};
    bytes.insert(bytes.end(), reinterpret_cast<const char*>(&header),
                 reinterpret_cast<const char*>(&header) + data_header_size);
    bytes.insert(bytes.end(), data.begin(), data.end());
}

std::string messageFor(const std::filesystem::path& path) {
    return test::computeError<types::ConfigError>([&] { Reader reader(path); });
}

TEST(ReaderTest, SamplesOfAllStreamsAreInFileOrder) {
    Folder folder;
    Writer log(folder / "x.0.log");
    const size_t a = log.addStream<double>("t.a");
    log.write(a, {10}, 1.0);
    const size_t b = log.addStream<int32_t>("t.b");  // declared in the middle of the file
    log.write(b, {20}, 2);
    log.write(a, {30}, 3.0);
    log.close();
    Reader reader(folder / "x.0.log");
    ASSERT_EQ(reader.samples().size(), 3u);
    EXPECT_EQ(reader.samples()[1].stream, 1u);
    EXPECT_EQ(reader.samples()[2].time.microseconds, 30);
    std::vector<double> values;
    reader.forEach<double>("t.a", [&](double value, const SampleRef&) { values.push_back(value); });
    EXPECT_THAT(values, testing::ElementsAre(1, 3));
}

TEST(ReaderTest, StreamsHaveCountSpanAndRate) {
    Folder folder;
    Writer log(folder / "x.0.log");
    const size_t stream = log.addStream<types::Pose>("vehicle.pose");
    log.addStream<double>("never.written");
    for (int i = 0; i <= 20; ++i) {
        types::Pose pose;
        pose.time = types::Time::fromSeconds(1 + 0.1 * i);
        log.write(stream, pose.time, pose);
    }
    log.close();
    const Reader got(folder / "x.0.log");
    EXPECT_EQ(got.bytes(), std::filesystem::file_size(folder / "x.0.log"));
    EXPECT_TRUE(got.complete());
    ASSERT_EQ(got.streams().size(), 2u);
    const Stream &pose_stream = got.streams()[0], &silent = got.streams()[1];
    EXPECT_EQ(pose_stream.name, "vehicle.pose");
    EXPECT_EQ(pose_stream.type, "/base/samples/RigidBodyState_m");
    EXPECT_EQ(pose_stream.count, 21u);
    EXPECT_DOUBLE_EQ(pose_stream.first.seconds(), 1);
    EXPECT_DOUBLE_EQ(pose_stream.last.seconds(), 3);
    EXPECT_NEAR(pose_stream.rate(), 10, 1e-9);
    EXPECT_EQ(silent.count, 0u);
    EXPECT_EQ(silent.rate(), 0);
}

TEST(ReaderTest, AStreamOfUnknownTypeIsListedAndSkipped) {
    Folder folder;
    std::vector<char> bytes = foreignLog("/gps/Solution");
    appendSample(bytes, {1, 2, 3}, false);
    append(bytes, BlockHeader{BlockType::Control, 0, 0, 4});
    append(bytes, uint32_t{0});
    writeBytes(folder / "x.0.log", bytes);
    Reader reader(folder / "x.0.log");
    EXPECT_TRUE(reader.complete()) << reader.diagnostic();
    EXPECT_EQ(reader.streams().at(0).type, "/gps/Solution");
    EXPECT_EQ(reader.streams()[0].count, 1u);
    EXPECT_EQ(reader.streams()[0].metadata, (Metadata{{"a", "b"}}));
    double value = 0;
    EXPECT_THROW(reader.read(reader.samples().at(0), value), types::ConfigError);
}

TEST(ReaderTest, CompressedSamplesAreRead) {
    Folder folder;
    uLongf size = compressBound(8000);
    std::vector<char> packed(size), payload;
    marshal(std::string(5000, 'x'), payload);
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<Bytef*>(payload.data()), payload.size());
    packed.resize(size);
    std::vector<char> bytes = foreignLog("/std/string");
    appendSample(bytes, packed, true);
    packed.resize(size / 2);
    appendSample(bytes, packed, true);
    writeBytes(folder / "x.0.log", bytes);
    Reader reader(folder / "x.0.log");
    std::string text;
    reader.read(reader.samples().at(0), text);
    EXPECT_EQ(text, std::string(5000, 'x'));
    EXPECT_THROW(reader.read(reader.samples().at(1), text), types::ConfigError);
}

TEST(ReaderTest, AFileThatIsNotALogIsAConfigurationError) {
    Folder folder;
    EXPECT_THAT(messageFor(folder / "absent.log"), HasSubstr("No such file"));
    EXPECT_THAT(messageFor(folder.path()), HasSubstr("is a folder; give a log in it"));
    writeBytes(folder / "empty.log", {});
    EXPECT_THAT(messageFor(folder / "empty.log"), HasSubstr("is not a pocolog file"));
    writeBytes(folder / "garbage.log", std::vector<char>(5000, 'g'));
    EXPECT_THAT(messageFor(folder / "garbage.log"), HasSubstr("does not start with POCOSIM"));
    writeBytes(folder / "big.log", foreignLog("/double", big_endian_flag));
    EXPECT_THAT(messageFor(folder / "big.log"), HasSubstr("big-endian"));
    std::vector<char> old = foreignLog("/double");
    old[8] = 1;
    writeBytes(folder / "old.log", old);
    EXPECT_THAT(messageFor(folder / "old.log"), HasSubstr("version 1"));
}

TEST(ReaderTest, AMissingStreamIsReportedWithTheExistingStreams) {
    Folder folder;
    writeBytes(folder / "x.0.log", foreignLog("/double"));
    Reader reader(folder / "x.0.log");
    EXPECT_EQ(reader.find("sonar.ping"), nullptr);
    EXPECT_THAT(test::computeError<types::ConfigError>([&] { reader.findIndex("sonar.ping"); }),
                HasSubstr("other.port"));
}

}  // namespace
}  // namespace insonify::log::pocolog
