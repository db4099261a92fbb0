#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

/** A folder in which the wall has run for three pings. */
class LogCommandTest : public testing::Test {
protected:
    LogCommandTest() { EXPECT_EQ(folder.run({"--pings", "3"}).code, 0); }
    Outcome exportTo(const std::string& stream, const std::string& to) {
        return callInsonify(folder, {"log", "export", log, "--stream", stream, "--to", to});
    }
    const WallFolder folder;
    const std::string log = "out/wall.0.log";
};

}  // namespace

TEST_F(LogCommandTest, InfoTellsStreamsTypesCountsAndRates) {
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

TEST_F(LogCommandTest, ALogThatWasCutOffIsReadUpToThere) {
    fs::resize_file(folder / log, fs::file_size(folder / log) - 5);
    const Outcome outcome = callInsonify(folder, {"log", "info", log, "--json"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_FALSE(json::parse(outcome.out)["complete"]);
    EXPECT_THAT(outcome.err, HasSubstr("notice: "));
}

TEST_F(LogCommandTest, ExportsPingsToNumpyWithTheWallWhereItStands) {
    ASSERT_EQ(exportTo("sonar.ping", "ping.npz").out, "ping.npz\n");
    const Outcome told = python(folder, R"(
import numpy
ping = numpy.load('ping.npz')
for name in ('bins', 'bearings', 'time', 'bin_duration', 'speed_of_sound'):
    print(name, ping[name].shape, ping[name].dtype)
spacing = ping['bin_duration'][0] * ping['speed_of_sound'][0]
print(abs(numpy.argmax(ping['bins'][0, 8]) * spacing - 10) < 2 * spacing)
print(ping['bearings'][0, 0] < 0 < ping['bearings'][0, -1]))");
    EXPECT_EQ(told.out,
              "bins (3, 16, 50) float32\nbearings (3, 16) float64\ntime (3,) float64\nbin_duration (3,) float64\n"
              "speed_of_sound (3,) float64\nTrue\nTrue\n")
        << told.err;
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

TEST_F(LogCommandTest, RefusesWhatItCannotExport) {
    EXPECT_EQ(exportTo("sonar.pong", "x.npz").code, 2);
    EXPECT_THAT(exportTo("sonar.pong", "x.npz").err, HasSubstr("sonar.ping"));
    EXPECT_EQ(exportTo("sonar.ping", "x.doc").code, 2);
    EXPECT_EQ(exportTo("sonar.ping", "nowhere/x.npz").code, 2);
    EXPECT_EQ(exportTo("vehicle.pose", "x.png").code, 2);
}

TEST(LogFileTest, AFileThatIsNoLogIsRefused) {
    const TestFolder folder;
    writeFile(folder / "empty.0.log", "");
    writeFile(folder / "text.0.log", "POCOSIN, almost a log, and long enough for a prologue");
    for (const char* file : {"empty.0.log", "text.0.log", ".", "nowhere.0.log"}) {
        const Outcome outcome = callInsonify(folder, {"log", "info", file});
        EXPECT_EQ(outcome.code, 2) << file;
        EXPECT_THAT(outcome.err, HasSubstr(file));
    }
}
