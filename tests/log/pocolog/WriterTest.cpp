#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>

#include "components/log/Files.hpp"
#include "components/log/pocolog/Reader.hpp"
#include "components/log/pocolog/Typelib.hpp"
#include "components/log/pocolog/Writer.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::log::pocolog {
namespace {

TEST(WriterTest, AFileIsAPrologueThenBlocks) {
    Folder folder;
    Writer log(folder / "x.0.log");
    log.write(log.addStream<double>("a.b"), {1'500'000}, 1.0);
    log.close();
    const std::vector<char> bytes = toBytes(folder / "x.0.log");
    const std::string_view text(bytes.data(), bytes.size());
    EXPECT_EQ(text.substr(0, 16), std::string_view("POCOSIM\0\2\0\0\0\0\0\0\0", 16));
    EXPECT_EQ(text.substr(16, 4), std::string_view("\1\xff\0\0", 4));
    EXPECT_EQ(text.substr(24, 8), std::string_view("\1\3\0\0\0a.b", 8));
    const std::string_view sample(
        "\2\xff\0\0\x1d\0\0\0"                                 // block: 21 + 8 bytes
        "\1\0\0\0\x20\xa1\7\0\1\0\0\0\x20\xa1\7\0\10\0\0\0\0"  // 1.5 s, 1.5 s, 8 bytes
        "\0\0\0\0\0\0\xf0\x3f",
        37);
    EXPECT_EQ(text.substr(text.size() - 37), sample);
}

TEST(WriterTest, AStreamHasTheMetadataOfRocksTools) {
    Folder folder;
    Writer log(folder / "x.0.log");
    log.addStream<types::Pose>("vehicle.pose", {{"insonify_seed", "7"}});
    log.close();
    Reader reader(folder / "x.0.log");
    EXPECT_EQ(reader.streams().at(0).metadata, (Metadata{{"rock_task_name", "vehicle"},
                                                         {"rock_task_object_name", "pose"},
                                                         {"rock_stream_type", "port"},
                                                         {"rock_cxx_type_name", "/base/samples/RigidBodyState"},
                                                         {"rock_orocos_type_name", "/base/samples/RigidBodyState"},
                                                         {"rock_timestamp_field", "time"},
                                                         {"insonify_seed", "7"}}));
    EXPECT_EQ(reader.streams()[0].type, "/base/samples/RigidBodyState_m");
    EXPECT_EQ(reader.layout(0), makeRegistry<types::Pose>());
}

TEST(WriterTest, TimesInTheHeadersNeverRunBackwardsButTheStampStays) {
    Folder folder;
    Writer log(folder / "x.0.log");
    const size_t stream = log.addStream<types::Pose>("a.b");
    for (const int64_t time : {-5, 20, 10}) {
        types::Pose pose;
        pose.time = {time};
        log.write(stream, {time + 1}, pose);
    }
    types::Pose late;
    late.time = {std::numeric_limits<int64_t>::max()};
    log.write(stream, late.time, late);
    log.close();
    Reader reader(folder / "x.0.log");
    std::vector<int64_t> times, received, stamps;
    reader.forEach<types::Pose>("a.b", [&](const types::Pose& pose, const SampleRef& at) {
        times.push_back(at.time.microseconds);
        received.push_back(at.received.microseconds);
        stamps.push_back(pose.time.microseconds);
    });
    EXPECT_THAT(times, testing::ElementsAre(0, 20, 20, latest_time.microseconds));
    EXPECT_THAT(received, testing::ElementsAre(0, 21, 21, latest_time.microseconds));
    EXPECT_THAT(stamps, testing::ElementsAre(-5, 20, 10, late.time.microseconds));
}

TEST(WriterTest, ASampleWithoutAStampHasTheTimeItWasReceived) {
    Folder folder;
    Writer log(folder / "x.0.log");
    log.write(log.addStream<types::Pose>("a.b"), {9}, types::Pose{});
    log.write(log.addStream<int32_t>("a.c"), {9}, 5);
    log.close();
    Reader reader(folder / "x.0.log");
    for (const SampleRef& at : reader.samples()) EXPECT_EQ(at.time.microseconds, 9);
}

TEST(WriterTest, FlushedSamplesAreReadableBeforeTheLogIsClosed) {
    Folder folder;
    Writer log(folder / "x.0.log");
    const size_t stream = log.addStream<double>("a.b");
    log.write(stream, {1}, 1.0);
    log.flush();
    log.write(stream, {2}, 2.0);
    Reader reader(folder / "x.0.log");
    EXPECT_TRUE(reader.complete());
    EXPECT_EQ(reader.samples().size(), 1u);
}

TEST(WriterTest, AMissingFolderIsAConfigurationError) {
    EXPECT_THROW(Writer("/nonexistent/x.0.log"), types::ConfigError);
    EXPECT_THROW(Writer("/"), types::ConfigError);
}

TEST(WriterTest, DoesNotOverwriteALogDuringItsWriting) {
    Folder folder;
    Writer log(folder / "x.0.log");
    log.write(log.addStream<double>("a.b"), {1}, 1.0);
    log.flush();
    EXPECT_THAT(test::computeError<types::ConfigError>([&] { Writer(folder / "x.0.log"); }),
                testing::HasSubstr("another logger writes it"));
    EXPECT_EQ(Reader(folder / "x.0.log").samples().size(), 1u);
    log.close();
    EXPECT_NO_THROW(Writer(folder / "x.0.log"));
}

TEST(WriterTest, ADeviceMayBeShared) {
    Folder folder;
    for (const char* file : {"x.0.log", "y.0.log"}) std::filesystem::create_symlink("/dev/null", folder / file);
    const Writer one(folder / "x.0.log");
    EXPECT_NO_THROW(Writer(folder / "y.0.log"));
}

TEST(WriterTest, ReportsAFullDeviceWithTheSystemsReason) {
    Folder folder;
    std::filesystem::create_symlink("/dev/full", folder / "x.0.log");
    Writer log(folder / "x.0.log");
    log.addStream<double>("a.b");
    EXPECT_THAT(test::computeError<std::runtime_error>([&] { log.flush(); }),
                testing::HasSubstr("No space left on device"));
}

/** Writes samples of 1000 bytes, with a flush after each, to a file limited to 20000 bytes; exits 0 when the error is
 *  reported. */
[[noreturn]] void fillLimitedFile(const std::filesystem::path& path) {
    const rlimit limit{20000, 20000};
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_IGN);
    Writer log(path);
    const size_t stream = log.addStream<std::string>("a.b");
    try {
        for (int i = 0; i < 100; ++i) {
            log.write(stream, {i}, std::string(1000, 'x'));
            log.flush();
        }
    } catch (const std::runtime_error&) {
        std::_Exit(0);
    }
    std::_Exit(1);
}

TEST(WriterTest, AFailedWriteLeavesTheFlushedBlocksIntact) {
    Folder folder;
    const std::filesystem::path path = folder / "x.0.log";
    EXPECT_EXIT(fillLimitedFile(path), testing::ExitedWithCode(0), "");
    Reader reader(path);
    EXPECT_TRUE(reader.complete()) << reader.diagnostic();
    EXPECT_GT(reader.samples().size(), 10u);
    EXPECT_LT(reader.samples().size(), 20u);
    reader.forEach<std::string>("a.b",
                                [](const std::string& text, const SampleRef&) { EXPECT_EQ(text.size(), 1000u); });
}

TEST(WriterTest, TheNextFileContinuesStreamsAndTimes) {
    Folder folder;
    Writer log(folder / "x.0.log");
    const size_t first = log.addStream<double>("a.b");
    const size_t second = log.addStream<int32_t>("a.c", {{"key", "value"}});
    log.write(first, {20}, 1.0);
    log.next(folder / "x.1.log");
    log.write(first, {10}, 2.0);
    log.write(second, {30}, 3);
    EXPECT_EQ(log.kept(), 1u);
    log.close();
    EXPECT_EQ(log.kept(), 3u);
    for (const char* file : {"x.0.log", "x.1.log"}) {
        const Verdict verdict = check(folder / file);
        EXPECT_FALSE(verdict.diagnostic) << file << ": " << verdict.diagnostic->message;
        EXPECT_TRUE(std::filesystem::exists(indexPath(folder / file)));
        EXPECT_EQ(Reader(folder / file).find("a.c")->metadata.at("key"), "value");
    }
    const Reader next(folder / "x.1.log");
    ASSERT_EQ(next.samples().size(), 2u);
    EXPECT_EQ(next.samples()[0].time.microseconds, 20) << "Rock joins the files of a sequence only in order of time";
}

TEST(WriterTest, NothingIsWrittenAfterTheEnd) {
    Folder folder;
    Writer log(folder / "x.0.log");
    const size_t stream = log.addStream<double>("a.b");
    log.close();
    EXPECT_THROW(log.write(stream, {1}, 1.0), std::runtime_error);
}

}  // namespace
}  // namespace insonify::log::pocolog
