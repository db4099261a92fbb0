// Replay of events during a logged run: extrapolated poses, changed properties.
#include <gmock/gmock.h>

#include "components/log/Copy.hpp"
#include "components/log/pocolog/Writer.hpp"
#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using namespace insonify;
namespace types = insonify::types;
using testing::HasSubstr;

namespace {

struct ReplayLiveTest : testing::Test {
    Outcome call(std::vector<std::string> words) const { return callInsonify(folder_, std::move(words)); }
    Outcome score(const std::string& log, std::vector<std::string> more = {}) const {
        std::vector<std::string> words = {"replay", log, "wall.yml", "--rerender", "--score", "--out", "scored"};
        words.insert(words.end(), more.begin(), more.end());
        return call(words);
    }
    /** Every ping of either stream has an equal ping in the other. */
    void expectAllSame(int compared) const {
        const json score = json::parse(readFile(folder_ / "scored/score.json"));
        EXPECT_EQ(score["streams"].size(), 2u);
        for (const json& stream : score["streams"]) {
            EXPECT_GE(stream["compared"], compared) << stream["stream"];
            EXPECT_EQ(stream["not_rendered"], 0) << stream["stream"];
            EXPECT_EQ(stream["other_shape"], 0) << stream["stream"];
            for (const json& ping : stream["pings"]) EXPECT_EQ(ping["rel_l2"], 0) << stream["stream"];
        }
    }
    /** A log of four pings at 1.0 to 1.3 s, of which the last two have another range, as after `setRange` at 1.2 s. */
    void recordAChange() const {
        recordAChange("sonar.range=20", "sonar.range=15",
                      [](log::Writer& to, size_t range) { to.write(range, {1'200'000}, 15.0); });
    }
    /** A log of four pings, with a changed property in the last two.
     *  @param report writes the change to the property log, given its stream of the property. */
    void recordAChange(const std::string& first, const std::string& second,
                       const std::function<void(log::Writer&, size_t)>& report) const {
        ASSERT_EQ(call({"run", "wall.yml", "--out", "out", "--pings", "4", "--set", first}).code, 0);
        ASSERT_EQ(call({"run", "wall.yml", "--out", "other", "--pings", "4", "--set", second}).code, 0);
        ASSERT_EQ(call({"log", "cut", "out/wall.0.log", "--until", "0.15", "--to", "a.0.log"}).code, 0);
        ASSERT_EQ(call({"log", "cut", "other/wall.0.log", "--from", "0.15", "--to", "b.0.log"}).code, 0);
        fs::create_directory(folder_ / "changed");
        log::copyLog({folder_ / "a.0.log", folder_ / "b.0.log"}, folder_ / "changed/wall.0.log");
        writeProperties(first.substr(0, first.find('=')), report);
    }
    void writeProperties(const std::string& property, const std::function<void(log::Writer&, size_t)>& report) const {
        const auto from = log::openLog(folder_ / "out/properties.0.log");
        log::pocolog::Writer to(folder_ / "changed/properties.0.log");
        for (size_t i = 0; i < from->streams().size(); ++i) to.addLike(*from, i);
        for (const log::SampleRef& at : from->samples()) to.copy(at.stream, *from, at);
        const log::Stream* const stream = from->find(property);
        report(to, stream ? from->findIndex(property) : 0);
        to.close();
    }

    const WallFolder folder_;
};

}  // namespace

TEST_F(ReplayLiveTest, ExtrapolatedPosesAreLoggedAsUsedAndScoreZero) {
    std::string text = replaced(wall_deployment, "schedule: lockstep", "schedule: realtime");
    text = replaced(text, "waypoints: [{time: 0, position: [0, 0, 0], roll_deg: 0, pitch_deg: 0, yaw_deg: 0}]",
                    "waypoints: [{time: 0, position: [0, 0, 0]}, {time: 60, position: [6, 3, 0], yaw_deg: 40}]");
    text =
        replaced(text, "properties: {file: wall.gltf}",
                 "properties: {file: wall.gltf, extrapolate: 0.5, mount: {position: [0.4, 0.1, -0.2], pitch_deg: 7}}");
    text = replaced(text, "to: noise.clean}", "to: noise.clean, policy: {type: buffer, size: 64}}");
    writeFile(folder_ / "wall.yml",
              text + "  - {from: sonar.pose, to: log.sonar_pose, policy: {type: buffer, size: 64}}\n");
    ASSERT_EQ(call({"run", "wall.yml", "--out", "out", "--pings", "4"}).code, 0);

    const auto recorded = log::openLog(folder_ / "out/wall.0.log");
    std::set<types::Time> poses;
    recorded->forEachRef("vehicle.pose", [&](const log::SampleRef& at) { poses.insert(at.time); });
    size_t carried = 0;
    recorded->forEachRef("sonar.ping", [&](const log::SampleRef& at) { carried += !poses.contains(at.time); });
    EXPECT_GT(carried, 0u) << "no ping was at another time than a pose";

    ASSERT_THAT(score("out/wall.0.log"), succeeds());
    expectAllSame(4);
}

TEST_F(ReplayLiveTest, ReplaysAChangeOfAPropertyDuringTheRun) {
    recordAChange();
    const Outcome outcome = score("changed/wall.0.log");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("notice: as in the log, from 1.200000 s on: sonar.range=15\n"));
    expectAllSame(4);
}

TEST_F(ReplayLiveTest, ReplaysTheRemovalOfAPropertyDuringTheRun) {
    recordAChange("sonar.absorption={db_per_m: 1}", "sonar.absorption=null", [](log::Writer& to, size_t) {
        to.write(to.addStream<bool>("sonar.absorption.present"), {1'200'000}, false);
    });
    const Outcome outcome = score("changed/wall.0.log");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("notice: as in the log, from 1.200000 s on: sonar.absorption=null\n"));
    expectAllSame(4);
}

TEST_F(ReplayLiveTest, APropertyAddedDuringTheRunIsAbsentBefore) {
    recordAChange("sonar.absorption=null", "sonar.absorption={db_per_m: 1}", [](log::Writer& to, size_t) {
        to.write(to.addStream<std::string>("sonar.absorption"), {1'200'000}, std::string("{\"db_per_m\": 1}"));
    });
    const Outcome outcome = score("changed/wall.0.log");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("from 1.200000 s on: sonar.absorption={\"db_per_m\": 1}\n"));
    expectAllSame(4);
}

TEST_F(ReplayLiveTest, APropertyRemovedBeforeTheRunIsRemovedAgain) {
    writeFile(folder_ / "wall.yml",
              replaced(wall_deployment, "range: 20", "range: 20\n      absorption: {db_per_m: 1}"));
    ASSERT_EQ(call({"run", "wall.yml", "--out", "out", "--pings", "3", "--set", "sonar.absorption=null"}).code, 0);
    const Outcome outcome = score("out/wall.0.log");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("notice: as in the log: sonar.absorption=null\n"));
    expectAllSame(3);
}

TEST_F(ReplayLiveTest, AReplayFromAfterAChangeStartsWithTheChangedValue) {
    recordAChange();
    const Outcome outcome = score("changed/wall.0.log", {"--from", "0.2"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("notice: as in the log: sonar.range=15\n"));
    const json score = json::parse(readFile(folder_ / "scored/score.json"));
    EXPECT_EQ(score["streams"][0]["compared"], 2);
    EXPECT_EQ(score["streams"][0]["other_shape"], 0);
}

TEST_F(ReplayLiveTest, TheUsersSettingOverridesARecordedChange) {
    recordAChange();
    const Outcome outcome = score("changed/wall.0.log", {"--set", "sonar.range=20"});
    EXPECT_THAT(outcome.out, HasSubstr("sonar.ping: 2 pings compared, 2 of other beams, bins or range"));
    EXPECT_THAT(outcome.err, testing::Not(HasSubstr("sonar.range")));
}

TEST_F(ReplayLiveTest, ANoticeReportsALogWithoutItsProperties) {
    ASSERT_EQ(call({"run", "wall.yml", "--out", "out", "--pings", "3"}).code, 0);
    EXPECT_THAT(score("out/wall.0.log").err, testing::Not(HasSubstr("properties")));
    fs::remove(folder_ / "out/properties.0.log");
    const Outcome outcome = score("out/wall.0.log");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_THAT(outcome.err, HasSubstr("notice: out/wall.0.log has no properties.0.log of its run next to it"));
    expectAllSame(3);
}

TEST_F(ReplayLiveTest, CutAndRepairCopyThePropertyLog) {
    ASSERT_EQ(call({"run", "wall.yml", "--out", "out", "--pings", "3", "--set", "sonar.range=15"}).code, 0);
    for (const char* command : {"cut", "repair"}) {
        const std::string to = command;
        fs::create_directory(folder_ / to);
        const Outcome outcome = call({"log", command, "out/wall.0.log", "--to", to + "/y.0.log"});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr("notice: " + to + "/properties.0.log is copied with it"));
        const auto kept = log::openLog(folder_ / to / "properties.0.log");
        EXPECT_EQ(kept->samples().size(), log::openLog(folder_ / "out/properties.0.log")->samples().size());
        EXPECT_THAT(score(to + "/y.0.log").err, HasSubstr("as in the log: sonar.range=15\n"));
        expectAllSame(3);
    }
    // Both logs have the same deployment and seed.
    ASSERT_EQ(call({"run", "wall.yml", "--out", "plain", "--pings", "3"}).code, 0);
    EXPECT_THAT(call({"log", "cut", "plain/wall.0.log", "--to", "cut/z.0.log"}).err,
                HasSubstr("cut/properties.0.log is of another run"));
    EXPECT_THAT(call({"log", "cut", "out/wall.0.log", "--to", "cut/again.0.log"}).err,
                testing::Not(HasSubstr("properties.0.log")))
        << "it is there";
    fs::create_directory(folder_ / "own");
    fs::copy_file(folder_ / "out/properties.0.log", folder_ / "own/properties.0.log");
    EXPECT_EQ(call({"log", "cut", "out/wall.0.log", "--to", "own/y.0.log"}).err, "") << "copied by hand";
    for (const char* cut : {"cut", "own"})
        for (const auto& entry : fs::directory_iterator(folder_ / cut))
            EXPECT_EQ(entry.path().filename().string().find("new"), std::string::npos) << entry.path();
    ASSERT_EQ(call({"run", "wall.yml", "--out", "again", "--pings", "1", "--seed", "3"}).code, 0);
    const Outcome other = call({"log", "cut", "out/wall.0.log", "--to", "again/y.0.log"});
    EXPECT_THAT(other.err, HasSubstr("again/properties.0.log is of another run"));
}

TEST_F(ReplayLiveTest, TasksThatCommunicateOutsideAreOmittedUnlessRequested) {
    if (call({"describe", "viewer::ViewerTask"}).code != 0) GTEST_SKIP() << "built without the viewer";
    ASSERT_EQ(call({"run", "wall.yml", "--out", "out", "--pings", "2"}).code, 0);
    std::string text = replaced(wall_deployment, "connections:\n",
                                "  view: {type: viewer::ViewerTask, properties: {port: 0}}\nconnections:\n");
    writeFile(folder_ / "wall.yml", text + "  - {from: noise.noisy, to: view.ping}\n");
    const Outcome alone = call({"replay", "out/wall.0.log", "wall.yml", "--rerender", "--out", "again"});
    EXPECT_EQ(alone.code, 0) << alone.err;
    EXPECT_THAT(
        alone.err,
        HasSubstr("notice: view is omitted, because it communicates outside the deployment; --outside runs it"));
    EXPECT_THAT(alone.err, testing::Not(HasSubstr("open http://")));
    const Outcome shown = call({"replay", "out/wall.0.log", "wall.yml", "--rerender", "--outside", "--out", "shown"});
    EXPECT_EQ(shown.code, 0) << shown.err;
    EXPECT_THAT(shown.err + shown.out, HasSubstr("open http://"));
}
