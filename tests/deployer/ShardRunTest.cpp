// Runs in shards: the pings equal those of the whole run, on any machine and after repetitions.
#include <gmock/gmock.h>

#include <iterator>
#include <map>

#include "components/deployer/ShardFolder.hpp"
#include "components/log/pocolog/Reader.hpp"
#include "tests/deployer/Wall.hpp"
#include "tests/support/Folder.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Sha256.hpp"

using namespace insonify::deployer;
using insonify::console::Json;
using insonify::console::Shard;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

namespace {

const std::string fan = R"(  fan:
    type: output::FanImageTask
    properties: {file: fan_%03d.png, width: 256, every: 3, reference_db: -20}
connections:
  - {from: noise.noisy, to: fan.ping}
)";

/** The wall, from a vehicle that approaches it, with pictures. */
std::string movingWall(const std::string& log = "wall.0.log") {
    std::string text = replaced(wall_deployment, "connections:\n", fan);
    text = replaced(text, "[{time: 0, position: [0, 0, 0], roll_deg: 0, pitch_deg: 0, yaw_deg: 0}]",
                    "[{time: 0, position: [0, 0, 0]}, {time: 1.9, position: [3, 1, 0], yaw_deg: 10}]");
    return replaced(text, "wall.0.log", log);
}

/** A turning head next to the wall, which moves past in steps of another period. */
const std::string scanning_deployment = R"(tasks:
  vehicle: {type: pose::TrajectoryTask, activity: {period: 0.1}, properties: {waypoints: [{time: 0, position: [0, 0, 0]}]}}
  wall:
    type: pose::TrajectoryTask
    activity: {period: 0.25}
    properties: {waypoints: [{time: 0, position: [0, 0, 0]}, {time: 4, position: [-4, 2, 0]}]}
  scene: {type: scene::SceneTask, properties: {file: wall.gltf}}
  sonar:
    type: sonar::ScanningSonarTask
    properties:
      range: 20
      bin_count: 100
      beam_width_deg: 3
      beam_height_deg: 10
      motion_in_ping: true
      quality: {rows: 32, columns_per_beam: 4}
      head: {step_deg: 5, left_deg: 40, right_deg: -40, sweeps: true}
  receiver: {type: receiver::ReceiverTask, properties: {output: code, code: {bits: 16, law: log}}}
  log: {type: logger::LoggerTask, properties: {file: wall.0.log}}
connections:
  - {from: vehicle.pose,   to: scene.pose}
  - {from: wall.pose,      to: scene.wall.pose}
  - {from: scene.snapshot, to: sonar.snapshot}
  - {from: sonar.ping,     to: receiver.intensity}
  - {from: receiver.ping,  to: log.ping, policy: {type: buffer, size: 64}}
  - {from: wall.pose,      to: log.wall, policy: {type: buffer, size: 64}}
  - {from: sonar.pose,     to: log.pose, policy: {type: buffer, size: 64}}
)";

std::map<std::string, std::string> filesIn(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files[entry.path().lexically_relative(folder)] = readFile(entry.path());
    return files;
}

struct Shards : WallFolder {
    using WallFolder::WallFolder;

    Outcome make(const std::string& shard, const std::string& out = "shards",
                 const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = {"run", "wall.yml", "--out", out, "--shard", shard};
        words.insert(words.end(), more.begin(), more.end());
        return callInsonify(*this, words);
    }
    void makeAll(int count, const std::vector<std::string>& more = {}, const std::string& out = "shards") const {
        for (int i = count - 1; i >= 0; --i) {
            ASSERT_THAT(make(std::to_string(i) + "/" + std::to_string(count), out, more), succeeds());
        }
    }
    /** All pictures, and the joined log. */
    std::map<std::string, std::string> joined(const std::string& log = "wall.0.log") const {
        std::map<std::string, std::string> all;
        std::vector<std::string> words = {"log", "cut"};
        for (const fs::path& shard : shards()) {
            words.push_back(shard / log);
            for (const auto& [name, bytes] : filesIn(shard))
                if (name.ends_with(".png")) {
                    EXPECT_TRUE(all.emplace(name, bytes).second) << name << " is there twice";
                }
        }
        fs::create_directory(*this / "joined");
        words.insert(words.end(), {"--to", "joined/" + log});
        EXPECT_THAT(callInsonify(*this, words), succeeds());
        all[log] = readFile(path() / "joined" / log);
        return all;
    }
    /** The same files of the whole run, with a copy of its log. */
    std::map<std::string, std::string> whole(const std::vector<std::string>& more = {},
                                             const std::string& log = "wall.0.log") const {
        EXPECT_THAT(run(more), succeeds());
        fs::create_directory(*this / "whole");
        EXPECT_EQ(callInsonify(*this, {"log", "cut", "out/" + log, "--to", "whole/" + log}).code, 0);
        std::map<std::string, std::string> all = filesIn(path() / "out");
        std::erase_if(all, [](const auto& file) { return !file.first.ends_with(".png"); });
        all[log] = readFile(path() / "whole" / log);
        return all;
    }
    std::vector<fs::path> shards(const std::string& out = "shards") const {
        std::vector<fs::path> all;
        for (const auto& entry : fs::directory_iterator(path() / out))
            if (entry.path().filename().string().starts_with("shard_")) all.push_back(entry.path());
        std::ranges::sort(all);
        return all;
    }
    /** Returns the files next to the shards that making them has left. */
    std::vector<std::string> leftovers(const std::string& out = "shards") const {
        std::vector<std::string> all;
        for (const auto& entry : fs::directory_iterator(path() / out))
            if (!entry.path().filename().string().starts_with("shard_")) all.push_back(entry.path());
        return all;
    }
};

void expectSame(const std::map<std::string, std::string>& shards, const std::map<std::string, std::string>& whole) {
    EXPECT_EQ(shards.size(), whole.size());
    for (const auto& [name, bytes] : whole) {
        ASSERT_TRUE(shards.contains(name)) << name;
        EXPECT_TRUE(shards.at(name) == bytes) << name << ": " << shards.at(name).size() << " and " << bytes.size();
    }
}

json readManifest(const fs::path& shard) { return json::parse(readFile(shard / "manifest.json")); }

TEST(ShardRunTest, JoinedShardsAreTheWholeRunByteForByte) {
    const Shards folder(movingWall());
    const std::vector<std::string> limit = {"--pings", "10", "--seed", "3", "--set", "sonar.bin_count=60"};
    folder.makeAll(3, limit);
    EXPECT_THAT(folder.leftovers(), IsEmpty());
    expectSame(folder.joined(), folder.whole(limit));
    std::vector<int> first, pings;
    for (const fs::path& shard : folder.shards()) {
        first.push_back(readManifest(shard)["first_ping"]);
        pings.push_back(readManifest(shard)["pings"]);
    }
    EXPECT_THAT(first, testing::ElementsAre(0, 3, 6));
    EXPECT_THAT(pings, testing::ElementsAre(3, 3, 4));
}

TEST(ShardRunTest, TracesRaysOnAnyDeviceUnlessVisibilityIsSet) {
    const auto getDevice = [](const std::string& visibility) {
        const Shards folder(replaced(wall_deployment, "range: 20", "range: 20" + visibility));
        std::vector<std::string> words = {"env", "INSONIFY_EGL_DEVICE=software"};
        std::ranges::copy(insonifyWords({"run", "wall.yml", "--out", "shards", "--pings", "2", "--shard", "1/2"}),
                          std::back_inserter(words));
        EXPECT_THAT(Process(words, folder.path()).wait(), succeeds());
        const insonify::log::pocolog::Reader log(folder.path() / "shards/shard_1_of_2/wall.0.log");
        const std::string plan = log.metadatum("insonify_plan");
        const size_t device = plan.find("\"device\": ");
        EXPECT_NE(device, plan.npos) << plan;
        return plan.substr(device, plan.find(',', device) - device);
    };
    const std::string rays = getDevice("\n      visibility: cpu"), rasterised = getDevice("\n      visibility: gl");
    EXPECT_NE(rays, rasterised);
    EXPECT_EQ(getDevice(""), rays);
    EXPECT_EQ(getDevice("\n      visibility: auto"), rays);
    EXPECT_EQ(getDevice("\n      deposit: gpu"), rasterised) << "which needs rasterisation";
}

TEST(ShardRunTest, HeadsAndNodesContinueAtTheirPlacesOfTheWholeRun) {
    const Shards folder(scanning_deployment);
    folder.makeAll(4, {"--pings", "23"});
    expectSame(folder.joined(), folder.whole({"--pings", "23"}));
}

TEST(ShardRunTest, CutsRunsLimitedByTheirTrajectoryOrATime) {
    {
        const Shards folder(movingWall());
        folder.makeAll(3);
        ASSERT_EQ(folder.shards().size(), 3u);
        EXPECT_EQ(readManifest(folder.shards().front())["pings_of_run"], 20);
        expectSame(folder.joined(), folder.whole());
    }
    const Shards folder(scanning_deployment);
    folder.makeAll(2, {"--duration", "1.2"});
    expectSame(folder.joined(), folder.whole({"--duration", "1.2"}));
}

TEST(ShardRunTest, McapFilesAreReproducibleAndJoinToTheWhole) {
    const Shards folder(movingWall("wall.0.mcap"));
    folder.makeAll(2, {"--pings", "8"});
    folder.makeAll(2, {"--pings", "8"}, "again");
    ASSERT_EQ(folder.shards().size(), 2u);
    ASSERT_EQ(folder.shards("again").size(), 2u);
    for (size_t i = 0; i < 2; ++i)
        EXPECT_EQ(readFile(folder.shards()[i] / "manifest.json"),
                  readFile(folder.shards("again")[i] / "manifest.json"));
    expectSame(folder.joined("wall.0.mcap"), folder.whole({"--pings", "8"}, "wall.0.mcap"));
}

TEST(ShardRunTest, TheManifestHasEveryFileWithItsHashAndNothingOfTheMachine) {
    const Shards folder(movingWall());
    folder.makeAll(1, {"--pings", "4"});
    ASSERT_EQ(folder.shards().size(), 1u);
    const fs::path shard = folder.shards().front();
    const json manifest = readManifest(shard);
    EXPECT_EQ(manifest["shard"], "0/1");
    EXPECT_EQ(manifest["run"]["pings"], 4);
    EXPECT_EQ(manifest["run"]["deployment"], "wall.yml");
    auto files = filesIn(shard);
    ASSERT_EQ(files.erase("manifest.json"), 1u);
    EXPECT_EQ(manifest["files"].size(), files.size());
    for (const json& file : manifest["files"]) {
        const std::string& bytes = files.at(file["file"]);
        EXPECT_EQ(file["bytes"], bytes.size());
        EXPECT_EQ(file["sha256"], insonify::types::sha256(bytes));
    }
    EXPECT_EQ(manifest.dump().find(folder.path().string()), std::string::npos);
}

TEST(ShardRunTest, AFinishedShardIsLeftUnchanged) {
    const Shards folder(movingWall());
    folder.makeAll(2, {"--pings", "6"});
    const auto before = fs::last_write_time(folder.path() / "shards/shard_1_of_2/wall.0.log");
    EXPECT_THAT(folder.make("1/2", "shards", {"--pings", "6"}),
                prints(AllOf(HasSubstr("shard 1/2: 3 pings from 3 on, of 6; "), HasSubstr("files existed already"))));
    EXPECT_EQ(fs::last_write_time(folder.path() / "shards/shard_1_of_2/wall.0.log"), before);
}

TEST(ShardRunTest, ABrokenFileIsFoundAndTheShardMadeAgain) {
    const Shards folder(movingWall());
    const std::vector<std::string> limit = {"--pings", "6"};
    folder.makeAll(2, limit);
    const fs::path shard = folder.path() / "shards/shard_0_of_2", log = shard / "wall.0.log";
    const auto good = filesIn(shard);
    const auto expectMended = [&](const std::string& what) {
        const Outcome outcome = folder.make("0/2", "shards", limit);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_THAT(outcome.err, AllOf(HasSubstr(what), HasSubstr("the shard is made again")));
        EXPECT_TRUE(filesIn(shard) == good);
    };
    std::string bytes = readFile(log);
    bytes[bytes.size() / 2] ^= 1;
    writeFile(log, bytes);
    expectMended("wall.0.log has another SHA-256 than when it was written");
    writeFile(log, bytes.substr(1));
    expectMended("wall.0.log has ");
    fs::remove(shard / "fan_000.png");
    expectMended("fan_000.png is missing");
    writeFile(shard / "manifest.json", "{");
    expectMended("its manifest.json is missing or broken");
    Json manifest = Json::parse(readFile(folder.path() / "shards/shard_1_of_2/manifest.json"));
    manifest["files"] = {1};
    writeFile(shard / "manifest.json", manifest.dump());
    expectMended("its manifest.json is broken: ");
    manifest["files"] = Json::array();
    manifest.erase("pings");
    writeFile(shard / "manifest.json", manifest.dump());
    expectMended("its manifest.json is broken: ");
}

TEST(ShardRunTest, ShardsOfTwoSimultaneousRunsAreNotMixed) {
    const insonify::Folder folder;
    ShardFolder one(folder / "shards", Shard::read("0/2"), {{"seed", 1}});
    ShardFolder other(folder / "shards", Shard::read("1/2"), {{"seed", 2}});
    ShardFolder rival(folder / "shards", Shard::read("0/2"), {{"seed", 2}});
    for (ShardFolder* each : {&one, &other, &rival}) each->begin();
    one.finish({{"pings", 3}});
    for (ShardFolder* each : {&other, &rival})
        EXPECT_THAT(
            [&] {
                each->finish({{"pings", 3}});
            },
            testing::ThrowsMessage<insonify::types::ConfigError>(HasSubstr("seed is 1 there, and 2 here")));
    EXPECT_FALSE(fs::exists(folder / "shards/shard_1_of_2"));
}

/** Returns the name of a file that a shard is writing; empty: there is none. */
std::string getPart(const fs::path& out) {
    if (!fs::exists(out)) return "";
    for (const auto& entry : fs::directory_iterator(out))
        if (entry.path().filename().string().starts_with(".shard_")) return entry.path();
    return "";
}

/** Waits until a shard has written a picture. */
void awaitPicture(const fs::path& out) {
    ASSERT_TRUE(insonify::test::becomesTrue([&] {
        const std::string part = getPart(out);
        return !part.empty() && fs::exists(part + "/fan_003.png");
    }));
}

/** More pings than a test waits for. */
const std::vector<std::string> endless = {"run", "wall.yml", "--out", "shards", "--shard", "0/2", "--pings", "4000000"};

TEST(ShardRunTest, AKilledShardIsMadeAgainAndLeavesNothing) {
    const Shards folder(movingWall());
    const Process process(insonifyWords(endless), folder.path());
    awaitPicture(folder / "shards");
    process.signal(SIGKILL);
    EXPECT_EQ(process.wait().code, -SIGKILL);
    EXPECT_THAT(folder.shards(), IsEmpty()) << "an incomplete shard has no final name";
    EXPECT_EQ(folder.leftovers().size(), 1u);
    folder.makeAll(2, {"--pings", "40"});
    EXPECT_THAT(folder.leftovers(), IsEmpty());
    expectSame(folder.joined(), folder.whole({"--pings", "40"}));
}

TEST(ShardRunTest, TwoProcessesMayMakeTheSameShardAndOneIsKept) {
    const Shards folder(movingWall());
    const TestFolder other;
    const std::string out = folder.path() / "shards";
    const std::vector<std::string> words = {
        "run", folder.path() / "wall.yml", "--out", out, "--shard", "0/2", "--pings", "200"};
    const Process first(insonifyWords(words), folder.path()), second(insonifyWords(words), other.path());
    EXPECT_EQ(first.wait().code, 0);
    EXPECT_EQ(second.wait().code, 0);
    EXPECT_EQ(folder.shards().size(), 1u);
    EXPECT_THAT(folder.leftovers(), IsEmpty());
    EXPECT_THAT(folder.make("0/2", "shards", {"--pings", "200"}).out, HasSubstr("existed already"));
}

TEST(ShardRunTest, AnInterruptedShardIsReportedAndNotKept) {
    const Shards folder(movingWall());
    const Process process(insonifyWords(endless), folder.path());
    awaitPicture(folder / "shards");
    process.signal(SIGTERM);
    const Outcome outcome = process.wait();
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.err, HasSubstr("interrupted; nothing is kept of the shard"));
    EXPECT_TRUE(fs::is_empty(folder / "shards"));
}

TEST(ShardRunTest, ReportsAnInvalidShardWithTheOption) {
    const Shards folder;
    const std::map<std::string, std::string> wrong = {{"0/0", "N must be from 1 to"},
                                                      {"5/4", "of 4 shards i may be from 0 to 3"},
                                                      {"-1/2", "it must be i/N, whole numbers"},
                                                      {"abc", "it must be i/N, whole numbers"}};
    for (const auto& [shard, why] : wrong) {
        EXPECT_THAT(folder.make(shard), isRefused(AllOf(HasSubstr("--shard"), HasSubstr(why)))) << shard;
        EXPECT_FALSE(fs::exists(folder / "shards"));
    }
    EXPECT_THAT(callInsonify(folder, {"run", "wall.yml", "--shard", "0/2"}),
                isRefused(HasSubstr("--out: is missing; all shards of a run share a folder")));
    EXPECT_THAT(folder.make("0/4", "shards", {"--pings", "3"}),
                isRefused(HasSubstr("the run has 3 pings, and so 3 shards at most")));
    EXPECT_TRUE(fs::is_empty(folder / "shards"));
    EXPECT_EQ(folder.make("0/2", "shards", {"--call", "log.stop"}).code, 2);
}

TEST(ShardRunTest, AFolderAcceptsTheShardsOfOneRunOnly) {
    const Shards folder;
    ASSERT_EQ(folder.make("0/2", "shards", {"--pings", "4"}).code, 0);
    const auto expectRefused = [&](const std::string& shard, std::vector<std::string> more, const std::string& why) {
        EXPECT_THAT(folder.make(shard, "shards", more),
                    isRefused(AllOf(HasSubstr("shards: --out: holds shards of "), HasSubstr(why))));
    };
    expectRefused("1/3", {"--pings", "4"}, "holds shards of 2, and this is one of 3");
    expectRefused("1/2", {"--pings", "5"}, "pings is 4 there, and 5 here");
    expectRefused("0/2", {"--pings", "4", "--seed", "9"}, "seed is 0 there, and 9 here");
    expectRefused("1/2", {"--pings", "4", "--set", "sonar.range=10"}, "set is [] there, and [\"sonar.range=10\"] here");
    writeFile(folder / "wall.yml", wall_deployment + "\n");
    expectRefused("1/2", {"--pings", "4"}, "deployment_sha256 is ");
}

/** Returns the errors of a run in shards for a deployment that cannot be cut. */
std::string refusal(const std::string& deployment) {
    const Shards folder(deployment);
    const Outcome outcome = folder.make("0/2", "shards", {"--pings", "4"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_TRUE(fs::is_empty(folder / "shards"));
    return outcome.err;
}

TEST(ShardRunTest, ReportsEachTaskWhoseStateAShardCannotKnow) {
    const std::string chosen =
        replaced(movingWall(), "quality: {rows: 32, columns_per_beam: 2}", "volume: {strength_db: -70}");
    EXPECT_THAT(refusal(replaced(chosen, ", reference_db: -20", "")),
                AllOf(HasSubstr("wall.yml: tasks.sonar: quality: is chosen from the pings before"),
                      HasSubstr("tasks.fan: reference_db: is absent, so the brightest colour follows the echoes")));
    EXPECT_THAT(refusal(replaced(movingWall(), "output::FanImageTask", "output::WaterfallImageTask")),
                HasSubstr("tasks.fan: its pictures also show earlier pings"));
    EXPECT_THAT(refusal(replaced(movingWall(), "every: 3", "every: 3, video: fan.avi")),
                HasSubstr("tasks.fan: video: is one file of all pictures"));
    EXPECT_THAT(refusal(replaced(movingWall(), "type: logger::LoggerTask",
                                 "type: logger::LoggerTask\n    activity: {period: 1}")),
                HasSubstr("tasks.log: has a period and reads from other tasks"));
    EXPECT_THAT(refusal(replaced(movingWall(), "schedule: lockstep", "schedule: realtime")),
                HasSubstr("schedule: is realtime"));
    EXPECT_THAT(refusal(replaced(movingWall(), "{from: noise.noisy, to: fan.ping}",
                                 "{from: noise.noisy, to: fan.ping}\n  - {from: sonar.pose, to: xtf.pose}\n"
                                 "  - {from: noise.noisy, to: xtf.ping}")
                            .insert(movingWall().find("  fan:"),
                                    "  xtf: {type: output::XtfTask, properties: {samples: float32}}\n")),
                HasSubstr("tasks.xtf: is a output::XtfTask, whose state depends on earlier pings"));
}

}  // namespace
