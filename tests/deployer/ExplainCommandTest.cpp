#include <gmock/gmock.h>

#include <cmath>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

std::vector<std::string> explain(const std::string& ping, const std::string& beam, const std::string& bin,
                                 const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"explain", "wall.yml", "--ping", ping, "--beam", beam, "--bin", bin};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/** The bins of the wall are 0.4 m long; beam 8 looks 1.9 deg to port, so that most of the wall is in bin 25, from 10.01
 * m on. */
constexpr const char *wall_beam = "8", *wall_bin = "25";

}  // namespace

TEST(ExplainCommandTest, PrintsWhatMadeTheBinOfTheWall) {
    const WallFolder folder;
    EXPECT_THAT(
        callInsonify(folder, explain("2", wall_beam, wall_bin)),
        prints(AllOf(HasSubstr("sonar, ping 2 at 1.100 s, beam 8 at 1.87 deg, bin 25 at 10.012 to 10.413 m: "),
                     HasSubstr("  100.00 %  wall, direct\n"),
                     HasSubstr("Lambert's law, -16.7 dB\n            grazing 85.9 deg, -16.7 dB there, elevation "),
                     HasSubstr("triangles "), HasSubstr("  then noise.noisy: "))));
    EXPECT_FALSE(fs::exists(folder / "wall.0.log")) << "the logger takes no part";
}

TEST(ExplainCommandTest, JsonHasTheBinOfThePingAndOfLaterTasks) {
    const WallFolder folder;
    const json all = makeJson(folder, explain("2", wall_beam, wall_bin));
    EXPECT_EQ(all["sonar"], "sonar");
    EXPECT_EQ(all["ping"], 2);
    EXPECT_EQ(all["intensity"], all["explained"]);
    EXPECT_GT(all["intensity"], 0);
    ASSERT_EQ(all["parts"].size(), 1u);
    const json& part = all["parts"][0];
    EXPECT_EQ(part["name"], "wall");
    EXPECT_EQ(part["share"], 1);
    EXPECT_NEAR(part["grazing_deg"], 86, 2);
    EXPECT_FALSE(part["triangles"].empty());
    EXPECT_EQ(all["why_no_surface"], "");
    EXPECT_GT(all["later"]["noise.noisy"], 0);
    EXPECT_NE(all["later"]["noise.noisy"], all["intensity"]);
    const json before = makeJson(folder, explain("2", wall_beam, "10"));
    EXPECT_THAT(before["why_no_surface"], HasSubstr("before the first surface of the beam, wall at 9.81 m"));
    EXPECT_TRUE(before["parts"].empty());
}

TEST(ExplainCommandTest, WrongPingsBeamsAndBinsAreRefused) {
    const WallFolder folder;
    const auto refused = [&](const std::string& ping, const std::string& beam, const std::string& bin) {
        const Outcome outcome = callInsonify(folder, explain(ping, beam, bin));
        EXPECT_EQ(outcome.code, 2) << outcome;
        EXPECT_EQ(outcome.out, "");
        return outcome.err;
    };
    EXPECT_EQ(refused("0", "8", "25"), "wall.yml: --ping: is 0; pings count from 1\n");
    EXPECT_EQ(refused("1", "16", "25"), "wall.yml: --beam: is 16; must be 0 to 15\n");
    EXPECT_EQ(refused("1", "8", "50"), "wall.yml: --bin: is 50; must be 0 to 49\n");
    for (const std::string wrong : {"-1", "1.5", "x", "1e3", "99999999999999999999"}) {
        EXPECT_THAT(refused(wrong, "8", "25"), HasSubstr("--ping: " + wrong + " is no whole number"));
        EXPECT_THAT(refused("1", wrong, "25"), HasSubstr("--beam: " + wrong + " is no whole number"));
        EXPECT_THAT(refused("1", "8", wrong), HasSubstr("--bin: " + wrong + " is no whole number"));
    }
}

TEST(ExplainCommandTest, APingBehindTheEndOfTheLogIsRefused) {
    const WallFolder folder;
    ASSERT_EQ(folder.run({"--pings", "3"}).code, 0);
    std::string replay = replaced(wall_deployment, "type: pose::TrajectoryTask\n    activity: {period: 0.1}\n",
                                  "type: replay::ReplayTask\n");
    replay = replaced(replay, "waypoints: [{time: 0, position: [0, 0, 0], roll_deg: 0, pitch_deg: 0, yaw_deg: 0}]",
                      "file: out/wall.0.log");
    replay = replaced(replay, "from: vehicle.pose, to: log", "from: vehicle.vehicle.pose, to: log");
    writeFile(folder / "wall.yml",
              replaced(replay, "from: vehicle.pose, to: scene", "from: vehicle.vehicle.pose, to: scene"));
    EXPECT_THAT(callInsonify(folder, explain("3", wall_beam, wall_bin)),
                prints(HasSubstr("  100.00 %  wall, direct\n")));
    EXPECT_THAT(callInsonify(folder, explain("4", wall_beam, wall_bin)),
                isRefused(HasSubstr("wall.yml: --ping: is 4; the run has 3 pings")));
}

TEST(ExplainCommandTest, OneOfSeveralSonarsIsChosen) {
    std::string two =
        replaced(wall_deployment, "  noise:\n",
                 "  second: {type: sonar::SonarTask, properties: {beam_count: 8, bin_count: 20}}\n  noise:\n");
    two = replaced(two, "  - {from: sonar.ping, to: noise.clean}\n",
                   "  - {from: sonar.ping, to: noise.clean}\n  - {from: scene.snapshot, to: second.snapshot}\n");
    const WallFolder folder(two);
    EXPECT_THAT(callInsonify(folder, explain("1", wall_beam, wall_bin)),
                isRefused(HasSubstr("--task: is absent, and there are several sonars; must be one of: sonar, second")));
    for (const std::string wrong : {"noise", "sona", "nothing"})
        EXPECT_THAT(
            callInsonify(folder, explain("1", wall_beam, wall_bin, {"--task", wrong})),
            isRefused(HasSubstr("--task: is " + wrong + ", which is no sonar here; must be one of: sonar, second")));
    EXPECT_EQ(makeJson(folder, explain("1", wall_beam, wall_bin, {"--task", "sonar"}))["parts"][0]["name"], "wall");
    EXPECT_EQ(makeJson(folder, explain("1", "0", "0", {"--task", "second"}))["sonar"], "second");
}

TEST(ExplainCommandTest, ADeploymentWithoutASonarIsRefused) {
    const WallFolder folder(
        "schedule: lockstep\ntasks:\n  vehicle: {type: pose::TrajectoryTask, activity: {period: 0.1}, properties: "
        "{waypoints: [{time: 0, position: [0, 0, 0], roll_deg: 0, pitch_deg: 0, yaw_deg: 0}]}}\n");
    EXPECT_THAT(callInsonify(folder, explain("1", "0", "0")), isRefused(HasSubstr("has no sonar")));
}

TEST(ExplainCommandTest, SettingsChangeTheExplanation) {
    const WallFolder folder;
    const json mean =
        makeJson(folder, explain("1", wall_beam, wall_bin,
                                 {"--set", "sonar.frequency_khz=300", "--set", "sonar.speckle={coherent: true}"}));
    EXPECT_TRUE(mean["is_mean"]);
    EXPECT_NE(mean["explained"], mean["intensity"]);
    EXPECT_EQ(mean["parts"][0]["name"], "wall");
}
