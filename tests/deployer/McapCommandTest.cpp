// MCAP files in all commands: logged, exported, inspected, replayed.
#include <gmock/gmock.h>

#include "components/log/Reader.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/MarineAcousticMessages.hpp"
#include "components/ros/Messages.hpp"
#include "tests/deployer/Wall.hpp"

using namespace insonify;
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

/** The detections of a profiler alone, in a run's bag and in one made of its pocolog file. */
TEST(DetectionsBagTest, ABagHasDetectionsWithTheFrequencyAndTheMountOfTheirSonar) {
    std::string text = replaced(wall_deployment, "sonar::SonarTask", "sonar::ProfilerTask");
    text = replaced(text, "range: 20\n", "range: 20\n      frequency_khz: 400\n");
    text = replaced(text, "{file: wall.gltf}", "{file: wall.gltf, mount: {position: [0.2, 0, -0.2]}}");
    text = replaced(text, "{from: sonar.ping, to: log.clean,", "{from: sonar.detections, to: log.found,");
    text = replaced(text, "  - {from: noise.noisy, to: log.noisy, policy: {type: buffer, size: 64}}\n", "");
    const WallFolder folder(text);
    ASSERT_THAT(folder.run({"--pings", "3", "--set", "log.file=wall.0.mcap"}), succeeds());
    ASSERT_THAT(callInsonify(folder, {"run", "wall.yml", "--pings", "3", "--out", "p"}), succeeds());
    ASSERT_THAT(callInsonify(folder, {"log", "export", "p/wall.0.log", "--to", "e/wall.mcap"}), succeeds());
    for (const char* bag : {"out/wall.0.mcap", "e/wall.mcap"}) {
        SCOPED_TRACE(bag);
        EXPECT_THAT(readFile(folder / fs::path(bag).parent_path() / "metadata.yaml"),
                    AllOf(HasSubstr("marine_acoustic_msgs/msg/SonarDetections"), HasSubstr("/tf_static")));
        const auto log = log::openLog(folder / bag);
        size_t pings = 0;
        log->forEachRef("sonar.detections", [&](const log::SampleRef& at) {
            ros::SonarDetections message;
            ros::decode(log->toBytes(at), message);
            EXPECT_EQ(message.ping_info.frequency, 400e3f);
            EXPECT_EQ(message.header.frame_id, "sonar");
            ASSERT_EQ(message.two_way_travel_times.size(), 16u);
            for (size_t beam = 0; beam < 16; ++beam) {  // of the wall, 10 m ahead of the vehicle
                const double range = 9.8 / std::cos(static_cast<double>(message.rx_angles[beam]));
                EXPECT_NEAR(message.two_way_travel_times[beam] * message.ping_info.sound_speed / 2, range, 0.3) << beam;
            }
            ++pings;
        });
        EXPECT_EQ(pings, 3u);
    }
}

TEST_F(McapCommandTest, AnExportNextToAnotherBagHasNoMetadata) {
    ASSERT_THAT(call({"log", "export", "out/wall.0.log", "--to", "bags/first.mcap"}), succeeds());
    const std::string metadata = readFile(folder / "bags/metadata.yaml");
    EXPECT_THAT(metadata, HasSubstr("first.mcap"));
    const Outcome second = call({"log", "export", "out/wall.0.log", "--to", "bags/second.mcap"});
    EXPECT_THAT(second, prints(HasSubstr("bags/second.mcap: 9 messages")));
    EXPECT_THAT(second.err, HasSubstr("notice: bags/second.mcap: the folder has the metadata.yaml of another bag"));
    EXPECT_EQ(readFile(folder / "bags/metadata.yaml"), metadata) << "the other bag stays";
    EXPECT_TRUE(readFile(folder / "bags/first.mcap") == readFile(folder / "bags/second.mcap"));
    EXPECT_THAT(call({"log", "check", "bags/second.mcap"}), succeeds());
    EXPECT_EQ(call({"log", "export", "out/wall.0.log", "--to", "bags/first.mcap"}).err, "") << "again, as itself";
}

TEST_F(McapCommandTest, MistakesAreNamed) {
    const auto expectError = [&](std::vector<std::string> words, const std::string& message) {
        EXPECT_THAT(call(std::move(words)), isRefused(HasSubstr(message)));
    };
    expectError({"log", "export", "out/wall.0.log", "--to", "x.npz"}, "--stream: is missing");
    expectError({"log", "export", "out/wall.0.log", "--stream", "no.port", "--to", "x.mcap"},
                "there is no such stream");
    ASSERT_EQ(call({"log", "export", "out/wall.0.log", "--to", "wall.mcap"}).code, 0);
    expectError({"log", "cut", "out/wall.0.log", "--to", "other.mcap"}, "describes another bag");
    expectError({"log", "export", "wall.mcap", "--to", "wall.mcap"}, "it is the log that is read");
    fs::resize_file(folder / "wall.mcap", fs::file_size(folder / "wall.mcap") - 5);
    expectError({"log", "check", "wall.mcap"},
                "byte " + std::to_string(fs::file_size(folder / "wall.mcap")) + ": the file ends within");
    EXPECT_FALSE(json::parse(call({"log", "info", "wall.mcap", "--json"}).out)["complete"]);
    writeFile(folder / "none.mcap", "nothing");
    expectError({"log", "info", "none.mcap"}, "none.mcap: is no MCAP file");
}
