// Transforms of bags, followed from each ping to the world by rosbags and mcap-ros2-support.
#include <gmock/gmock.h>

#include <random>

#include "components/log/Reader.hpp"
#include "tests/deployer/Wall.hpp"
#include "tests/support/Python.hpp"
#include "types/samples/Pose.hpp"

using namespace insonify;
using namespace insonify::deployer;
using testing::ElementsAre;

namespace {

constexpr int ping_count = 6;

struct TransformsRunTest : testing::Test {
    void SetUp() override {
        if (!pythonHas("mcap, mcap_ros2, rosbags, numpy"))
            GTEST_SKIP() << "SKIPPED: Python packages mcap, mcap_ros2, rosbags and numpy; scripts/setup installs them";
    }
    double uniform(double limit) { return std::uniform_real_distribution<double>(-limit, limit)(random_); }
    types::Mount randomMount() {
        return {{uniform(2), uniform(2), uniform(2)}, uniform(180), uniform(180), uniform(180)};
    }
    /** A vehicle that turns and passes the wall, with a mount and keys of `mcap`. */
    std::string deployment(const types::Mount& mount, const std::string& mcap) {
        const auto& p = mount.position;
        const std::string angles = fmt(", roll_deg: ", mount.roll_deg) + fmt(", pitch_deg: ", mount.pitch_deg) +
                                   fmt(", yaw_deg: ", mount.yaw_deg);
        std::string text = replaced(wall_deployment, "{file: wall.gltf}",
                                    "{file: wall.gltf, mount: {position: [" + fmt("", p.x) + fmt(", ", p.y) +
                                        fmt(", ", p.z) + "]" + angles + "}}");
        text = replaced(text, "yaw_deg: 0}]",
                        "yaw_deg: 0}, {time: 1, position: [" + fmt("", uniform(3)) + fmt(", ", uniform(3)) +
                            fmt(", ", uniform(3)) + "]" + fmt(", roll_deg: ", uniform(90)) +
                            fmt(", pitch_deg: ", uniform(80)) + fmt(", yaw_deg: ", uniform(170)) + "}]");
        return replaced(text, "wall.0.log}", "wall.0.log, mcap: {" + mcap + "}}");
    }
    /** Returns the output of follow_transforms.py. */
    static json followed(const WallFolder& folder, const std::string& bag) {
        const std::string answer =
            pythonSays(test::sourceFile("tests/deployer/follow_transforms.py") + " " + (folder / bag).string(),
                       folder / "followed.txt");
        if (answer.starts_with("{")) return json::parse(answer);
        ADD_FAILURE() << answer;
        return {{"pings", json::array()}};
    }
    /** Whether each ping's frame is at the sonar's place by pose and mount. @param toWorld from Rock's axes */
    static void expectPlaces(const json& pings, const WallFolder& folder, const types::Mount& mount,
                             const auto& toWorld, bool z_forward) {
        std::map<int64_t, types::Pose> poses;
        log::openLog(folder / "out/wall.0.log")
            ->forEach<types::Pose>("vehicle.pose", [&](const types::Pose& pose, const log::SampleRef&) {
                poses[pose.time.microseconds * 1000] = pose;
            });
        ASSERT_EQ(pings.size(), 2u * ping_count);
        for (const json& ping : pings) {
            types::Pose sonar;
            types::place(poses.at(ping["time"]), mount, sonar);
            const auto direction = [&](glm::dvec3 v) { return toWorld(sonar.orientation * v); };
            const glm::dvec3 ahead = direction({1, 0, 0}), port = direction({0, 1, 0}), up = direction({0, 0, 1});
            expectNear(ping["position"], toWorld(sonar.position));
            expectNear(ping["axes"][0], z_forward ? up : ahead);
            expectNear(ping["axes"][1], z_forward ? -port : port);
            expectNear(ping["axes"][2], z_forward ? ahead : up);
            EXPECT_EQ(ping["chain"], (json{"sonar", "body", "world"}));
        }
    }

    std::mt19937 random_{20261126};

private:
    static std::string fmt(const std::string& before, double number) { return before + std::to_string(number); }
    static void expectNear(const json& found, glm::dvec3 expected) {
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[static_cast<size_t>(i)].get<double>(), expected[i], 2e-6);
    }
};

glm::dvec3 inEnu(glm::dvec3 v) { return {-v.y, v.x, v.z}; }
glm::dvec3 inNed(glm::dvec3 v) { return {v.x, -v.y, -v.z}; }
glm::dvec3 inRock(glm::dvec3 v) { return v; }

const std::vector<std::string> six_pings = {"--pings", std::to_string(ping_count)};

}  // namespace

TEST_F(TransformsRunTest, LeadFromEachPingByTheMountAndThePoseToTheWorld) {
    struct Case {
        std::string mcap;
        glm::dvec3 (*to_world)(glm::dvec3);
        bool z_forward;
    };
    for (const Case& each :
         {Case{"world_frame: enu", inEnu, true}, Case{"world_frame: enu, frame: x_forward", inEnu, false},
          Case{"world_frame: ned", inNed, true}, Case{"world_frame: ned, frame: x_forward", inNed, false},
          Case{"world_frame: as_is", inRock, true}}) {
        SCOPED_TRACE(each.mcap);
        const types::Mount mount = randomMount();
        const WallFolder folder(deployment(mount, each.mcap));
        ASSERT_EQ(folder.run(six_pings).code, 0);
        ASSERT_THAT(
            callInsonify(folder, {"run", "wall.yml", "--out", "bag", "--pings", "6", "--set", "log.file=wall.0.mcap"}),
            succeeds());
        const json found = followed(folder, "bag/wall.0.mcap");
        expectPlaces(found["pings"], folder, mount, each.to_world, each.z_forward);
        EXPECT_EQ(found["topics"]["/tf"], ping_count);
        EXPECT_EQ(found["topics"]["/tf_static"], 1);
        ASSERT_EQ(found["clock"].size(), ping_count * 1u);
        EXPECT_TRUE(std::ranges::is_sorted(found["clock"]));
        EXPECT_EQ(found["clock"].back(), found["pings"].back()["time"]);
    }
}

TEST_F(TransformsRunTest, AreInExportedAndCutBagsAndNotStreams) {
    const types::Mount mount = randomMount();
    const WallFolder folder(deployment(mount, "world_frame: enu"));
    ASSERT_EQ(folder.run(six_pings).code, 0);
    const auto call = [&](std::vector<std::string> words) {
        const Outcome outcome = callInsonify(folder, std::move(words));
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome.out;
    };
    EXPECT_EQ(call({"log", "export", "out/wall.0.log", "--to", "bag/wall.mcap"}), "bag/wall.mcap: 18 messages\n");
    expectPlaces(followed(folder, "bag/wall.mcap")["pings"], folder, mount, inEnu, true);
    EXPECT_EQ(call({"log", "check", "bag/wall.mcap"}), "bag/wall.mcap: valid, 3 streams, 18 samples\n");
    fs::create_directory(folder / "cut");
    call({"log", "cut", "bag/wall.mcap", "--to", "cut/part.mcap", "--from", "0.25"});
    const json part = followed(folder, "cut/part.mcap");
    EXPECT_EQ(part["pings"].size(), 6u);
    EXPECT_EQ(part["pings"][0]["chain"], (json{"sonar", "body", "world"}));
    call({"log", "cut", "out/wall.0.log", "--to", "cut/part.mcap"});
    expectPlaces(followed(folder, "cut/part.mcap")["pings"], folder, mount, inEnu, true);
    const std::string info = call({"log", "info", "cut/part.mcap"});
    EXPECT_EQ(info.find("/tf"), std::string::npos) << info;
}

TEST_F(TransformsRunTest, ABagReplaysAndScoresTheSameWithAndWithoutThem) {
    const WallFolder folder(deployment(types::Mount{{0.5, 0, 0}, 0, 5, 0}, "world_frame: ned"));
    const auto call = [&](std::vector<std::string> words) {
        EXPECT_THAT(callInsonify(folder, std::move(words)), succeeds());
    };
    for (const std::string transforms : {"true", "false"}) {
        call({"run", "wall.yml", "--out", transforms, "--pings", "6", "--set", "log.file=wall.0.mcap", "--set",
              "log.mcap.transforms=" + transforms});
        call({"replay", transforms + "/wall.0.mcap", "wall.yml", "--out", "again_" + transforms, "--rerender",
              "--score"});
    }
    EXPECT_EQ(json::parse(readFile(folder / "again_true/score.json")).at("streams"),
              json::parse(readFile(folder / "again_false/score.json")).at("streams"));
    const json without = followed(folder, "false/wall.0.mcap");
    EXPECT_EQ(without["topics"].size(), 3u);
    EXPECT_THAT(without["pings"][0]["chain"], ElementsAre("sonar"));
    const auto with_size = fs::file_size(folder / "true/wall.0.mcap"),
               without_size = fs::file_size(folder / "false/wall.0.mcap");
    EXPECT_LT(with_size - without_size, ping_count * 250u + 8000u) << "a transform and a time of each pose; schemas";
}
