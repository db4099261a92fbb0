// MCAP files in all commands: logged, exported, inspected, replayed.
#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

/** A folder with a run of the wall for three pings, logged as pocolog in out/. */
struct McapCommandTest : testing::Test {
    McapCommandTest() { EXPECT_EQ(folder.run({"--pings", "3"}).code, 0); }
    Outcome call(std::vector<std::string> words) const { return callInsonify(folder, std::move(words)); }
    /** Whether two logs have the same pings, except for the rounding of bearings. */
    void expectSamePings(const std::string& a, const std::string& b,
                         const std::string& stream_of_b = "noise.noisy") const {
        ASSERT_EQ(call({"log", "export", a, "--stream", "noise.noisy", "--to", "a.npz"}).code, 0);
        ASSERT_THAT(call({"log", "export", b, "--stream", stream_of_b, "--to", "b.npz"}), succeeds());
        const Outcome reported = python(folder, R"(
import numpy
a, b = numpy.load('a.npz'), numpy.load('b.npz')
same = all(a[k].tobytes() == b[k].tobytes() for k in ('bins', 'time', 'bin_duration', 'speed_of_sound'))
print(a['bins'].shape, same, abs(a['bearings'] - b['bearings']).max() < 1e-15))");
        EXPECT_EQ(reported.out, "(3, 16, 50) True True\n") << reported.err;
    }
    const WallFolder folder;
};

}  // namespace

TEST_F(McapCommandTest, ARunLogsWhatAPocologRunLogs) {
    ASSERT_EQ(call({"run", "wall.yml", "--out", "m", "--pings", "3", "--set", "log.file=wall.0.mcap"}).code, 0);
    expectSamePings("out/wall.0.log", "m/wall.0.mcap");
    const Outcome info = call({"log", "info", "m/wall.0.mcap", "--json"});
    const json reported = json::parse(info.out);
    EXPECT_TRUE(reported["complete"]);
    ASSERT_EQ(reported["streams"].size(), 3u);
    for (const json& stream : reported["streams"]) EXPECT_EQ(stream["count"], 3) << stream;
    EXPECT_EQ(call({"log", "check", "m/wall.0.mcap"}).out, "m/wall.0.mcap: valid, 3 streams, 9 samples\n");
}

TEST_F(McapCommandTest, APocologFileExportedAndReplayedGivesTheSamePings) {
    const Outcome exported = call({"log", "export", "out/wall.0.log", "--to", "wall.mcap"});
    ASSERT_EQ(exported.out, "wall.mcap: 9 messages\n") << exported.err;
    expectSamePings("out/wall.0.log", "wall.mcap");
    ASSERT_THAT(call({"replay", "wall.mcap", "wall.yml", "--out", "again"}), succeeds());
    expectSamePings("out/wall.0.log", "again/wall.0.log", "noise.noisy");
}

TEST_F(McapCommandTest, PosesOfAnMcapFileGiveTheSamePings) {
    ASSERT_EQ(call({"log", "export", "out/wall.0.log", "--to", "wall.mcap", "--world-frame", "ned"}).code, 0);
    ASSERT_THAT(call({"replay", "wall.mcap", "wall.yml", "--out", "again", "--rerender", "--score"}), succeeds());
    expectSamePings("out/wall.0.log", "again/rerendered.0.log");
}

TEST_F(McapCommandTest, OneStreamIsExportedAlone) {
    EXPECT_EQ(
        call({"log", "export", "out/wall.0.log", "--stream", "sonar.ping", "--to", "p.mcap", "--dtype", "uint8"}).out,
        "p.mcap: 3 messages\n");
    EXPECT_EQ(json::parse(call({"log", "info", "p.mcap", "--json"}).out)["streams"].size(), 1u);
}

TEST_F(McapCommandTest, MistakesAreNamed) {
    const auto expectError = [&](std::vector<std::string> words, const std::string& message) {
        EXPECT_THAT(call(std::move(words)), isRefused(HasSubstr(message)));
    };
    expectError({"log", "export", "out/wall.0.log", "--to", "x.npz"}, "--stream: is missing");
    expectError({"log", "export", "out/wall.0.log", "--stream", "no.port", "--to", "x.mcap"},
                "there is no such stream");
    ASSERT_EQ(call({"log", "export", "out/wall.0.log", "--to", "wall.mcap"}).code, 0);
    expectError({"log", "export", "out/wall.0.log", "--to", "other.mcap"}, "describes another bag");
    expectError({"log", "export", "wall.mcap", "--to", "wall.mcap"}, "it is the log that is read");
    fs::resize_file(folder / "wall.mcap", fs::file_size(folder / "wall.mcap") - 5);
    expectError({"log", "check", "wall.mcap"},
                "byte " + std::to_string(fs::file_size(folder / "wall.mcap")) + ": the file ends within");
    EXPECT_FALSE(json::parse(call({"log", "info", "wall.mcap", "--json"}).out)["complete"]);
    writeFile(folder / "none.mcap", "nothing");
    expectError({"log", "info", "none.mcap"}, "none.mcap: is no MCAP file");
}
