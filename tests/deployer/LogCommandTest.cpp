#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

/** A folder with a run of the wall for three pings. */
struct LogCommandTest : testing::Test {
    LogCommandTest() { EXPECT_EQ(folder.run({"--pings", "3"}).code, 0); }
    Outcome exportTo(const std::string& stream, const std::string& to) {
        return callInsonify(folder, {"log", "export", log, "--stream", stream, "--to", to});
    }
    const WallFolder folder;
    const std::string log = "out/wall.0.log";
};

}  // namespace

TEST_F(LogCommandTest, InfoPrintsStreamsTypesCountsAndRates) {
    const json info = json::parse(callInsonify(folder, {"log", "info", log, "--json"}).out);
    EXPECT_EQ(info["bytes"], fs::file_size(folder / log));
    EXPECT_TRUE(info["complete"]);
    std::vector<std::string> names;
    for (const json& stream : info["streams"]) {
        names.push_back(stream["name"]);
        EXPECT_EQ(stream["count"], 3);
        EXPECT_NEAR(stream["rate_hz"], 10, 0.01);
        EXPECT_NEAR(stream["last_s"].get<double>() - stream["first_s"].get<double>(), 0.2, 1e-6);
    }
    EXPECT_THAT(names, testing::UnorderedElementsAre("sonar.ping", "noise.noisy", "vehicle.pose"));
}

TEST_F(LogCommandTest, ATruncatedLogIsReadUpToItsEnd) {
    fs::resize_file(folder / log, fs::file_size(folder / log) - 5);
    const Outcome outcome = callInsonify(folder, {"log", "info", log, "--json"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_FALSE(json::parse(outcome.out)["complete"]);
    EXPECT_THAT(outcome.err, HasSubstr("notice: "));
}

TEST_F(LogCommandTest, ExportsPingsToNumpyWithTheWallAtItsRange) {
    ASSERT_EQ(exportTo("sonar.ping", "ping.npz").out, "ping.npz\n");
    const Outcome reported = python(folder, R"(
import numpy
ping = numpy.load('ping.npz')
for name in ('bins', 'bearings', 'time', 'bin_duration', 'speed_of_sound'):
    print(name, ping[name].shape, ping[name].dtype)
spacing = ping['bin_duration'][0] * ping['speed_of_sound'][0]
print(abs(numpy.argmax(ping['bins'][0, 8]) * spacing - 10) < 2 * spacing)
print(ping['bearings'][0, 0] < 0 < ping['bearings'][0, -1]))");
    EXPECT_EQ(reported.out,
              "bins (3, 16, 50) float32\nbearings (3, 16) float64\ntime (3,) float64\nbin_duration (3,) float64\n"
              "speed_of_sound (3,) float64\nTrue\nTrue\n")
        << reported.err;
}

TEST_F(LogCommandTest, ExportsToAFolder) {
    ASSERT_EQ(exportTo("vehicle.pose", "numbers").code, 0);
    EXPECT_EQ(python(folder, "import numpy; print(numpy.load('numbers/vehicle.pose.npz')['orientation'].shape)").out,
              "(3, 4)\n");
}

TEST_F(LogCommandTest, ExportsToText) {
    ASSERT_EQ(exportTo("noise.noisy", "noisy.csv").code, 0);
    const std::string text = readFile(folder / "noisy.csv");
    EXPECT_TRUE(text.starts_with("time,beam,bearing,bin,value\n"));
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 3 * 16 * 50);
}

TEST_F(LogCommandTest, ExportsFanPictures) {
    ASSERT_EQ(exportTo("sonar.ping", "fan.png").out, "fan_000000.png\nfan_000001.png\nfan_000002.png\n");
    EXPECT_TRUE(readFile(folder / "fan_000002.png").starts_with("\x89PNG"));
}

TEST_F(LogCommandTest, CutsASpanOfTimeOrNumbersOutOfALog) {
    const auto cut = [&](std::vector<std::string> more) {
        std::vector<std::string> words = {"log", "cut", log, "--to", "cut.0.log"};
        words.insert(words.end(), more.begin(), more.end());
        return callInsonify(folder, words);
    };
    EXPECT_EQ(cut({"--from", "0.05", "--until", "0.15"}).out, "cut.0.log: 3 samples, nothing was lost\n");
    EXPECT_EQ(callInsonify(folder, {"log", "check", "cut.0.log"}).out, "cut.0.log: valid, 3 streams, 3 samples\n");
    EXPECT_TRUE(fs::exists(folder / "cut.0.idx"));
    EXPECT_EQ(cut({"--stream", "sonar.ping", "--samples", "1:"}).out, "cut.0.log: 2 samples, nothing was lost\n");
    EXPECT_EQ(cut({"out/properties.0.log", "--stream", "sonar.ping", "--stream", "noise.seed"}).out,
              "cut.0.log: 4 samples, nothing was lost\n")
        << "several files, several streams";
    EXPECT_THAT(
        cut({log, "--stream", "sonar.ping"}).err,
        HasSubstr("notice: sonar.ping of out/wall.0.log begins before it ends in out/wall.0.log; the copy has "));
    const std::string before = readFile(folder / "cut.0.log");
    const Outcome nothing = cut({"--from", "7"});
    EXPECT_EQ(nothing.code, 2);
    EXPECT_THAT(nothing.err, HasSubstr("out/wall.0.log: none of its samples is in the requested part; they are from "
                                       "1.000000 s to 1.200000 s"));
    EXPECT_EQ(nothing.out, "");
    EXPECT_TRUE(readFile(folder / "cut.0.log") == before) << "the cut before stays";
    EXPECT_TRUE(fs::exists(folder / "cut.0.idx"));
    for (const char* fresh : {"none.0.log", "none.mcap"}) {
        EXPECT_EQ(callInsonify(folder, {"log", "cut", log, "--to", fresh, "--from", "7"}).code, 2);
        EXPECT_THAT(callInsonify(folder, {"log", "cut", log, "--to", fresh, "--from", "-1"}),
                    isRefused(HasSubstr("--from: is -1; must not be negative")));
        EXPECT_FALSE(fs::exists(folder / fresh)) << fresh;
    }
    EXPECT_THAT(cut({"--samples", "2:1"}).err, HasSubstr("--samples: is 2:1; FIRST must be less than LAST"));
    EXPECT_THAT(cut({"--from", "0.1", "--until", "0.05"}).err, HasSubstr("--until: is 0.05; must be after --from"));
    EXPECT_THAT(callInsonify(folder, {"log", "cut", log, "--to", "cut.txt"}).err,
                HasSubstr("cut.txt: --to: must end in .log or .mcap"));
    EXPECT_EQ(cut({"--samples", "1"}).code, 2);
    EXPECT_THAT(cut({"--samples", "a:b"}).err, HasSubstr("may be FIRST:LAST"));
    EXPECT_EQ(cut({"--stream", "no.such"}).code, 2);
    EXPECT_EQ(callInsonify(folder, {"log", "cut", log, "--to", log}).code, 2);
    EXPECT_THAT(callInsonify(folder, {"log", "cut", log, "--to", "out/properties.0.log"}).err,
                HasSubstr("is the name of a log of properties"));
    EXPECT_EQ(callInsonify(folder, {"log", "check", log}).code, 0) << "the log is unchanged";
}

TEST_F(LogCommandTest, MakesTheFolderOfAnOutputFile) {
    EXPECT_EQ(callInsonify(folder, {"log", "cut", log, "--to", "deep/er/cut.0.log"}).code, 0);
    EXPECT_EQ(exportTo("sonar.ping", "deep/too/ping.npz").code, 0);
    writeFile(folder / "plain", "a file");
    for (const char* to : {"deep/er/cut.0.log/ping.npz", "plain"}) {
        EXPECT_THAT(exportTo("sonar.ping", to), isRefused(HasSubstr("--to: is no folder and cannot be made")));
    }
}

TEST_F(LogCommandTest, ADamagedLogIsNamedByItsFirstWrongByteAndRepaired) {
    std::string bytes = readFile(folder / log);
    fs::remove(folder / "out/wall.0.idx");
    const size_t stray = bytes.size() - 4;
    writeFile(folder / log, bytes.substr(0, stray));
    EXPECT_THAT(callInsonify(folder, {"log", "check", log}),
                isRefused(testing::MatchesRegex("out/wall.0.log: byte [0-9]+: the file ends within a block: it has "
                                                "[0-9]+ bytes, [0-9]+ are left\n")));
    const json reported = json::parse(callInsonify(folder, {"log", "check", log, "--json"}).out);
    EXPECT_FALSE(reported["valid"]);
    EXPECT_EQ(reported["samples"], 8);
    EXPECT_EQ(reported["wrong"]["file"], log);
    EXPECT_GT(reported["wrong"]["byte"], 0);

    const Outcome repaired = callInsonify(folder, {"log", "repair", log, "--to", "whole.0.log"});
    EXPECT_THAT(repaired, prints("whole.0.log: 8 samples, lost in 1 places\n"));
    EXPECT_THAT(repaired.err, testing::StartsWith("lost: out/wall.0.log: bytes "));
    const json valid = json::parse(callInsonify(folder, {"log", "check", "whole.0.log", "--json"}).out);
    EXPECT_TRUE(valid["valid"]);
    EXPECT_TRUE(valid["wrong"].is_null());
}

TEST_F(LogCommandTest, TheLogHasItsPlanAndThePropertyLogNextToIt) {
    const std::string text = readFile(folder / log);
    for (const char* key : {"insonify_plan: ", "insonify_deployment: ", "insonify_seed: "})
        EXPECT_THAT(text, HasSubstr(key));
    const json info = json::parse(callInsonify(folder, {"log", "info", "out/properties.0.log", "--json"}).out);
    std::vector<std::string> names;
    for (const json& stream : info["streams"]) names.push_back(stream["name"]);
    EXPECT_THAT(names, testing::IsSupersetOf({"sonar.range", "noise.seed", "noise.speckle", "scene.file"}));
    EXPECT_EQ(callInsonify(folder, {"log", "check", "out/properties.0.log"}).code, 0);
    EXPECT_EQ(callInsonify(folder, {"replay", "out/properties.0.log", "wall.yml", "--out", "again"}).code, 2)
        << "properties are not samples of ports";
}

TEST_F(LogCommandTest, RefusesWhatItCannotExport) {
    EXPECT_EQ(exportTo("sonar.pong", "x.npz").code, 2);
    EXPECT_THAT(exportTo("sonar.pong", "x.npz").err, HasSubstr("sonar.ping"));
    EXPECT_EQ(exportTo("sonar.ping", "x.doc").code, 2);
    EXPECT_EQ(exportTo("sonar.ping", "wall.yml/x.npz").code, 2);
    EXPECT_EQ(exportTo("vehicle.pose", "x.png").code, 2);
    const auto withOption = [&](const char* option, const char* value, const char* to) {
        return callInsonify(folder, {"log", "export", log, "--stream", "sonar.ping", "--to", to, option, value});
    };
    EXPECT_EQ(withOption("--dtype", "uint8", "x.mcap").code, 0);
    EXPECT_THAT(withOption("--dtype", "uint8", "x.npz").err, HasSubstr("--dtype: is for FILE.mcap; --to is x.npz"));
    const Outcome wrong = withOption("--world-frame", "north", "y.mcap");
    EXPECT_EQ(wrong.code, 2);
    EXPECT_THAT(wrong.err, testing::MatchesRegex("--world-frame: is north; may be .*ned.*\n"));
    EXPECT_THAT(withOption("--to", "y.npz", "x.npz").err, HasSubstr("--to: is given more than once"));
    EXPECT_THAT(callInsonify(folder, {"log", "info", "out"}).err, HasSubstr("out: is a folder; give a log in it"));
    EXPECT_THAT(callInsonify(folder, {"log", "import", "out", "--to", "z.0.log"}).err,
                HasSubstr("out: is a folder; give a recording in it"));
}

TEST(LogFrameTest, LoggedFramesAreExportedAsPictures) {
    std::string text = replaced(wall_deployment, "  log:\n",
                                "  fan: {type: output::FanImageTask, properties: {width: 256}}\n  log:\n");
    text +=
        "  - {from: noise.noisy, to: fan.ping}\n  - {from: fan.image, to: log.fan, policy: {type: buffer, size: 9}}\n";
    const WallFolder folder(text);
    ASSERT_EQ(folder.run().code, 0);
    const auto exportTo = [&](const char* to) {
        return callInsonify(folder, {"log", "export", "out/wall.0.log", "--stream", "fan.image", "--to", to});
    };
    EXPECT_EQ(exportTo("frame.png").out, "frame_000000.png\nframe_000001.png\n");
    EXPECT_TRUE(readFile(folder / "frame_000001.png").starts_with("\x89PNG"));
    ASSERT_EQ(exportTo("frame.npz").code, 0);
    EXPECT_THAT(python(folder, "import numpy; print(numpy.load('frame.npz')['pixels'].shape)").out,
                testing::MatchesRegex("\\(2, [0-9]+, 256, 3\\)\n"));
    EXPECT_THAT(exportTo("frame.csv").err, HasSubstr("pictures: .png and .npz"));
}

TEST(LogFileTest, RefusesAFileThatIsNotALog) {
    const TestFolder folder;
    writeFile(folder / "empty.0.log", "");
    writeFile(folder / "text.0.log", "POCOSIN, almost a log, and long enough for a prologue");
    for (const char* file : {"empty.0.log", "text.0.log", ".", "nowhere.0.log"}) {
        for (const char* command : {"info", "check"}) {
            EXPECT_THAT(callInsonify(folder, {"log", command, file}), isRefused(HasSubstr(file)))
                << command << " " << file;
        }
    }
}
