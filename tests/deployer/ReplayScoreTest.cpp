// A log rendered again and compared with its pings.
#include <gmock/gmock.h>

#include "components/log/pocolog/Reader.hpp"
#include "components/log/pocolog/Writer.hpp"
#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using namespace insonify;
namespace types = insonify::types;
using testing::HasSubstr;

namespace {

/** out/wall.0.log of the wall's deployment, and scores compared with it. */
struct ReplayScoreTest : testing::Test {
    void record(std::vector<std::string> more = {"--pings", "3"}) {
        ASSERT_THAT(folder_.run(std::move(more)), succeeds());
    }
    Outcome score(const std::string& log, std::vector<std::string> more = {}) const {
        std::vector<std::string> words = {"replay", log, "wall.yml", "--rerender", "--score", "--out", "scored"};
        words.insert(words.end(), more.begin(), more.end());
        return callInsonify(folder_, words);
    }
    /** Returns the streams in score.json by name; there must be two. */
    std::map<std::string, json> streams() const {
        std::map<std::string, json> result;
        const json score = json::parse(readFile(folder_ / "scored/score.json"));
        for (const json& stream : score["streams"]) result[stream["stream"]] = stream;
        EXPECT_EQ(result.size(), 2u);
        return result;
    }
    void expectSame(const json& stream) const {
        EXPECT_EQ(stream["compared"], 3);
        for (const json& ping : stream["pings"]) {
            for (const char* error : {"rel_l2", "rel_l2_tvg", "first_return_bins", "level_distance_db", "energy_bias"})
                EXPECT_EQ(ping[error], 0) << error;
            EXPECT_EQ(ping["correlation"], 1);
            EXPECT_NEAR(ping["ssim"], 1, 1e-12);
        }
    }
    /** Returns a copy of the log with the poses from the `first` on 10 cm ahead, and without one of its metadata. */
    void shiftPoses(int first, const std::string& without = "") const {
        log::pocolog::Reader from(folder_ / "out/wall.0.log");
        log::pocolog::Writer to(folder_ / "shifted.0.log");
        std::vector<size_t> numbers;
        for (const log::Stream& stream : from.streams()) {
            log::Metadata metadata = stream.metadata;
            metadata.erase(without);
            numbers.push_back(stream.holds<types::Pose>() ? to.addStream<types::Pose>(stream.name, metadata)
                                                          : to.addStream<types::Sonar>(stream.name, metadata));
        }
        types::Pose pose;
        types::Sonar ping;
        for (const log::SampleRef& at : from.samples()) {
            if (from.streams()[at.stream].holds<types::Pose>()) {
                from.read(at, pose);
                if (first-- <= 0) pose.position.x += 0.1;
                to.write(numbers[at.stream], at.received, pose);
            } else {
                from.read(at, ping);
                to.write(numbers[at.stream], at.received, ping);
            }
        }
        to.close();
    }

    const WallFolder folder_;
};

}  // namespace

TEST_F(ReplayScoreTest, ASimulatedLogScoresRelativeL2ZeroAndCorrelationOne) {
    record();
    ASSERT_THAT(score("out/wall.0.log"),
                prints(HasSubstr("noise.noisy: 3 pings compared; relative L2 0 to 0, median 0\n")));
    for (const auto& [name, stream] : streams()) expectSame(stream);
    EXPECT_TRUE(fs::exists(folder_ / "scored/score_000005.png")) << "three pings of each stream";
    EXPECT_FALSE(fs::exists(folder_ / "scored/score_000006.png"));
}

/** A log of several files is what one of a single file is, for each command that takes its first file. */
TEST_F(ReplayScoreTest, ARotatedLogIsOne) {
    const std::vector<std::string> large = {"--pings", "12", "--set", "sonar.bin_count=2000"};
    const auto recordTo = [&](const std::string& out, std::vector<std::string> more) {
        std::vector<std::string> words = {"run", "wall.yml", "--out", out};
        words.insert(words.end(), large.begin(), large.end());
        words.insert(words.end(), more.begin(), more.end());
        ASSERT_THAT(callInsonify(folder_, words), succeeds());
    };
    recordTo("one", {});
    recordTo("many", {"--set", "log.max_file_size=1000000"});
    ASSERT_TRUE(fs::exists(folder_ / "many/wall.2.log"));
    const auto call = [&](std::vector<std::string> words) { return callInsonify(folder_, std::move(words)); };
    const std::string notice = "notice: many/wall.0.log is continued in ";

    const Outcome info = call({"log", "info", "many/wall.0.log", "--json"});
    EXPECT_THAT(info.err, HasSubstr(notice));
    EXPECT_EQ(json::parse(info.out)["streams"],
              json::parse(call({"log", "info", "one/wall.0.log", "--json"}).out)["streams"]);
    EXPECT_EQ(json::parse(call({"log", "info", "one/wall.0.log", "many/wall.1.log", "--json"}).out).size(), 2u);
    EXPECT_THAT(call({"log", "info", "one/wall.0.log", "many/wall.1.log"}).out,
                testing::AllOf(HasSubstr("one/wall.0.log: "), HasSubstr("many/wall.1.log: ")));
    for (const char* log : {"one", "many"}) {
        EXPECT_THAT(call({"log", "export", std::string(log) + "/wall.0.log", "--stream", "noise.noisy", "--to",
                          std::string(log) + ".npz"}),
                    succeeds());
        EXPECT_THAT(call({"log", "export", std::string(log) + "/wall.0.log", "--to", std::string(log) + ".mcap"}),
                    prints(HasSubstr(" messages")));
        fs::remove(folder_ / "metadata.yaml");
        EXPECT_THAT(call({"log", "cut", std::string(log) + "/wall.0.log", "--from", "0.35", "--to",
                          std::string(log) + "_cut/x.0.log"}),
                    succeeds());
    }
    EXPECT_TRUE(readFile(folder_ / "one.npz") == readFile(folder_ / "many.npz"));
    EXPECT_TRUE(readFile(folder_ / "one.mcap") == readFile(folder_ / "many.mcap"));
    EXPECT_TRUE(readFile(folder_ / "one_cut/x.0.log") == readFile(folder_ / "many_cut/x.0.log"));
    std::vector<std::string> listed = {"log", "cut", "--to", "listed/x.0.log", "--from", "0.35"};
    for (const auto& [number, file] : log::findSequence(folder_ / "many/wall.0.log"))
        listed.push_back("many/" + file.filename().string());
    EXPECT_EQ(call(listed).err.find("is continued in"), std::string::npos);
    EXPECT_TRUE(readFile(folder_ / "one_cut/x.0.log") == readFile(folder_ / "listed/x.0.log"));

    const Outcome scored = score("many/wall.0.log", {"--set", "sonar.bin_count=2000"});
    EXPECT_THAT(scored, prints(HasSubstr("noise.noisy: 12 pings compared; relative L2 0 to 0, median 0\n")));
    EXPECT_THAT(scored.err, HasSubstr("many/wall.0.log is continued in "));
}

TEST_F(ReplayScoreTest, PointTargetsAreInTheReplayAsInTheRun) {
    const std::string target = "scene.targets=[{name: buoy, position: [6, 0.5, 0], strength_db: 10}]";
    record({"--pings", "3", "--set", target});
    ASSERT_THAT(score("out/wall.0.log"), succeeds());
    for (const auto& [name, stream] : streams()) expectSame(stream);
    fs::remove_all(folder_ / "scored");
    ASSERT_THAT(score("out/wall.0.log", {"--set", "scene.targets=[]"}), succeeds());
    for (const auto& [name, stream] : streams())
        for (const json& ping : stream["pings"]) EXPECT_GT(ping["rel_l2"], 0.1);
}

TEST_F(ReplayScoreTest, PosesShiftedByTenCentimetresScoreWorse) {
    record();
    shiftPoses(0);
    ASSERT_THAT(score("shifted.0.log"), succeeds());
    for (const auto& [name, stream] : streams())
        for (const json& ping : stream["pings"]) {
            RecordProperty(name + "_rel_l2", ping["rel_l2"].dump());
            EXPECT_GT(ping["rel_l2"], 0.05) << name;
            EXPECT_LT(ping["correlation"], 0.999) << name;
            EXPECT_LT(ping["ssim"], 0.999) << name;
        }
}

TEST_F(ReplayScoreTest, TheWorstPingIsFirstInTableAndPictures) {
    record();
    shiftPoses(2);
    const Outcome outcome = score("shifted.0.log", {"--worst", "1"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const auto& [name, stream] : streams()) {
        EXPECT_NEAR(stream["pings"][0]["time"], 1.2, 1e-6);
        EXPECT_GT(stream["pings"][0]["rel_l2"], 0.05);
        EXPECT_EQ(stream["pings"][1]["rel_l2"], 0);
        EXPECT_EQ(stream["pings"][2]["rel_l2"], 0);
    }
    EXPECT_THAT(outcome.out, HasSubstr("\n                1.200000 s "));
    EXPECT_THAT(outcome.out, testing::Not(HasSubstr("\n                1.100000 s ")));
    EXPECT_TRUE(fs::exists(folder_ / "scored/score_000001.png")) << "one of each stream";
    EXPECT_FALSE(fs::exists(folder_ / "scored/score_000002.png"));
}

TEST_F(ReplayScoreTest, UsesTheLogsSeed) {
    record({"--pings", "3", "--seed", "5"});
    ASSERT_EQ(score("out/wall.0.log").code, 0);
    for (const auto& [name, stream] : streams()) expectSame(stream);
    ASSERT_EQ(score("out/wall.0.log", {"--seed", "6"}).code, 0);
    expectSame(streams().at("sonar.ping"));
    for (const json& ping : streams().at("noise.noisy")["pings"]) EXPECT_GT(ping["rel_l2"], 0.5);
}

TEST_F(ReplayScoreTest, SeedZeroIsTheFilesSeed) {
    record({"--pings", "3", "--seed", "5"});
    ASSERT_EQ(score("out/wall.0.log", {"--seed", "0"}).code, 0);
    for (const json& ping : streams().at("noise.noisy")["pings"]) EXPECT_GT(ping["rel_l2"], 0.5);
}

TEST_F(ReplayScoreTest, ADerivedSeedIsTheSameAgain) {
    writeFile(folder_ / "wall.yml", replaced(wall_deployment, "seed: 7, ", ""));
    record();
    ASSERT_EQ(score("out/wall.0.log").code, 0);
    for (const auto& [name, stream] : streams()) expectSame(stream);
    shiftPoses(1000);
    ASSERT_EQ(score("shifted.0.log").code, 0) << "without the log of properties";
    for (const auto& [name, stream] : streams()) expectSame(stream);
}

TEST_F(ReplayScoreTest, AnUnwrittenSeedIsOneInLogsOfEarlierVersions) {
    writeFile(folder_ / "wall.yml", replaced(wall_deployment, "seed: 7, ", ""));
    record({"--pings", "3", "--set", "noise.seed=1"});
    const Outcome outcome = score("out/wall.0.log");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("as in the log: noise.seed=1\n"));
    for (const auto& [name, stream] : streams()) expectSame(stream);
    shiftPoses(1000, "insonify_version");
    ASSERT_EQ(score("shifted.0.log").code, 0) << "without the log of properties";
    for (const auto& [name, stream] : streams()) expectSame(stream);
    ASSERT_EQ(score("shifted.0.log", {"--set", "noise.seed=2"}).code, 0);
    for (const json& ping : streams().at("noise.noisy")["pings"]) EXPECT_GT(ping["rel_l2"], 0.5);
}

TEST_F(ReplayScoreTest, UsesTheLogsChosenQuality) {
    writeFile(folder_ / "wall.yml", replaced(wall_deployment, "      quality: {rows: 32, columns_per_beam: 2}\n", ""));
    record({"--pings", "3", "--summary", "first.json"});
    const auto quality = [&](const char* file) { return json::parse(readFile(folder_ / file))["quality"]["sonar"]; };
    const json first = quality("first.json");
    ASSERT_FALSE(first["predicted_error"].is_null()) << "the sonar chose it";
    for (const char* from : {"0", "0.1"}) {
        ASSERT_THAT(score("out/wall.0.log", {"--from", from, "--summary", "again.json"}), succeeds());
        for (const auto& [name, stream] : streams()) {
            EXPECT_GE(stream["compared"], 2) << name;
            for (const json& ping : stream["pings"]) EXPECT_EQ(ping["rel_l2"], 0) << name;
        }
        const json again = quality("again.json");
        for (const char* key : {"rows", "columns_per_beam"}) EXPECT_EQ(again[key], first[key]) << key;
        EXPECT_TRUE(again["predicted_error"].is_null()) << "and does not choose again";
    }
    ASSERT_EQ(score("out/wall.0.log", {"--set", "sonar.quality={rows: 16}", "--summary", "again.json"}).code, 0);
    EXPECT_EQ(quality("again.json")["rows"], 16) << "the user's setting overrides";
}

TEST_F(ReplayScoreTest, TakesSettingsOfTheRunFromTheLogsProperties) {
    record({"--pings", "3", "--set", "sonar.range=15", "--set", "sonar.speed_of_sound=1480", "--set",
            "sonar.absorption={db_per_m: 0.1}", "--set", "noise.seed=9"});
    const Outcome outcome = score("out/wall.0.log");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("as in the log: sonar.range=15\n"));
    for (const auto& [name, stream] : streams()) expectSame(stream);

    const Outcome other = score("out/wall.0.log", {"--set", "sonar.range=12"});
    EXPECT_THAT(other.err, testing::Not(HasSubstr("as in the log: sonar.range")));
    EXPECT_THAT(other.err, HasSubstr("as in the log: sonar.speed_of_sound=1480\n"));
}

TEST_F(ReplayScoreTest, ExactBinsAreComparedInLogsOfThisAndOlderVersions) {
    for (const char* format : {"wall.0.log", "wall.mcap"}) {
        record({"--pings", "3", "--set", "sonar.range_rounding=exact", "--set", "sonar.bin_count=3000", "--set",
                std::string("log.file=") + format});
        ASSERT_THAT(score(std::string("out/") + format), succeeds());
        for (const auto& [name, stream] : streams()) expectSame(stream);
    }
    log::pocolog::Reader from(folder_ / "out/wall.0.log");
    fs::create_directory(folder_ / "older");
    fs::copy_file(folder_ / "out/properties.0.log", folder_ / "older/properties.0.log");
    {
        log::pocolog::Writer to(folder_ / "older/wall.0.log");  // with the water's speed of sound, and no width
        for (log::Stream stream : from.streams()) {
            stream.metadata.erase("insonify_bin_width");
            to.add(*stream.sample, stream.name, stream.metadata);
        }
        for (const log::SampleRef& at : from.samples()) {
            if (from.streams()[at.stream].holds<types::Sonar>()) {
                types::Sonar ping;
                from.read(at, ping);
                EXPECT_DOUBLE_EQ(ping.binWidth(), 20.0 / 3000);
                ping.bin_width = 0;
                to.write(at.stream, at.received, ping);
            } else
                to.put(at.stream, at.received, at.time, from.sampleAt(at));
        }
    }
    ASSERT_THAT(score("older/wall.0.log"), succeeds());
    for (const auto& [name, stream] : streams()) expectSame(stream);
}

TEST_F(ReplayScoreTest, AnErrorOfAValueFromTheLogNamesTheLog) {
    writeFile(folder_ / "other.gltf", readFile(folder_ / "wall.gltf"));
    record({"--pings", "3", "--set", "scene.file=other.gltf"});
    fs::remove(folder_ / "other.gltf");
    EXPECT_THAT(score("out/wall.0.log"),
                isRefused(AllOf(HasSubstr("out/wall.0.log: tasks.scene.properties.file: "),
                                HasSubstr("; the value is the log's, and --set overrides it\n"),
                                testing::Not(HasSubstr("--set: ")))));
    EXPECT_THAT(score("out/wall.0.log", {"--set", "scene.file=wall.gltf"}), succeeds());
}

TEST_F(ReplayScoreTest, AScanningSonarScoresAsWell) {
    std::string scanning = replaced(wall_deployment, "sonar::SonarTask", "sonar::ScanningSonarTask");
    scanning =
        replaced(scanning, "      beam_count: 16\n", "      head: {left_deg: 30, right_deg: -30, step_deg: 10}\n");
    scanning = replaced(scanning, "      field_of_view_deg: 60\n", "");
    writeFile(folder_ / "wall.yml", scanning);
    record();
    ASSERT_THAT(score("out/wall.0.log"), succeeds());
    for (const auto& [name, stream] : streams()) expectSame(stream);
    EXPECT_THAT(score("out/wall.0.log", {"--from", "0.1"}),
                isRefused(HasSubstr("tasks.sonar: is a scanning sonar, whose head starts at its left limit")));
}

TEST_F(ReplayScoreTest, LevelsAreComparedAsEnergies) {
    std::string levels = replaced(wall_deployment, "properties: {seed: 7, speckle: {law: rayleigh}}",
                                  "properties: {seed: 7}\n"
                                  "  receiver: {type: receiver::ReceiverTask, properties: {output: level_db}}");
    levels = replaced(levels, "{from: noise.noisy, to: log.noisy,",
                      "{from: noise.noisy, to: receiver.intensity}\n  - {from: receiver.ping, to: log.level,");
    writeFile(folder_ / "wall.yml", levels);
    record();
    shiftPoses(0);
    ASSERT_EQ(score("out/wall.0.log").code, 0);
    for (const auto& [name, stream] : streams()) {
        expectSame(stream);
        EXPECT_EQ(stream["display"]["scale"], name == "receiver.ping" ? "decibel" : "linear") << name;
    }
    ASSERT_EQ(score("shifted.0.log").code, 0);
    for (const auto& [name, stream] : streams()) EXPECT_GT(stream["pings"][0]["rel_l2"], 0.05);
}

TEST_F(ReplayScoreTest, CountsPingsOfAnotherShapeAndFailsWithoutComparablePings) {
    record();
    const Outcome outcome = score("out/wall.0.log", {"--set", "sonar.beam_count=32"});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.err, HasSubstr("no ping of out/wall.0.log could be compared"));
    EXPECT_THAT(outcome.out, HasSubstr("3 of other beams, bins or range"));
    EXPECT_EQ(streams().at("sonar.ping")["other_shape"], 3);
}

TEST_F(ReplayScoreTest, FromTheMiddleOnCountsTheOtherPings) {
    record();
    const Outcome outcome = score("out/wall.0.log", {"--from", "0.1"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("warning: noise.noisy: not all pings were compared: 1 not rendered again\n"));
    EXPECT_EQ(streams().at("noise.noisy")["compared"], 2);
    EXPECT_EQ(streams().at("noise.noisy")["not_rendered"], 1);
    EXPECT_EQ(streams().at("noise.noisy")["pings"][0]["rel_l2"], 0);
}

TEST_F(ReplayScoreTest, RefusesWhatCannotBeScored) {
    record();
    EXPECT_EQ(callInsonify(folder_, {"replay", "out/wall.0.log", "wall.yml", "--score"}).code, 2) << "not rendered";
    const std::string pose_only = replaced(
        replaced(wall_deployment, "  - {from: sonar.ping, to: log.clean, policy: {type: buffer, size: 64}}\n", ""),
        "  - {from: noise.noisy, to: log.noisy, policy: {type: buffer, size: 64}}\n", "");
    writeFile(folder_ / "wall.yml", pose_only);
    record();
    EXPECT_THAT(score("out/wall.0.log"), isRefused(HasSubstr("holds no pings of a task of wall.yml")));
    EXPECT_FALSE(fs::exists(folder_ / "scored"));
}

TEST_F(ReplayScoreTest, ALogWithoutPosesIsRefused) {
    writeFile(
        folder_ / "wall.yml",
        replaced(wall_deployment, "  - {from: vehicle.pose, to: log.pose, policy: {type: buffer, size: 64}}\n", ""));
    record();
    EXPECT_THAT(score("out/wall.0.log"),
                isRefused(HasSubstr("none of its streams is of a task of wall.yml before its sonars")));
}
