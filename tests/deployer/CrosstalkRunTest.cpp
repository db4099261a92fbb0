// Crosstalk of two vehicles, in runs of the command.
#include <gmock/gmock.h>

#include "tests/deployer/SceneRun.hpp"

using namespace insonify::deployer;
using insonify::types::Sonar;

namespace {

// Bins are 100 us at 1000 m/s: 0.1 m. Vehicle two is 20 m to port of vehicle one, and both look at each other, past the
// wall. Each pulse of two is 4 ms, or 2 m of slant range, later than that of one.
const char* const pair = R"(tasks:
  one: {type: pose::TrajectoryTask, activity: {period: 0.1}, properties: {waypoints: [{time: 0, position: [0, -10, 0], yaw_deg: 90}]}}
  two: {type: pose::TrajectoryTask, activity: {period: 0.104}, properties: {waypoints: [{time: 0, position: [0, 10, 0], yaw_deg: -90}]}}
  one_scene: {type: scene::SceneTask, activity: {trigger: [pose]}, properties: {file: case.glb}}
  two_scene: {type: scene::SceneTask, activity: {trigger: [pose]}, properties: {file: case.glb}}
  one_sonar: {type: sonar::SonarTask, properties: &sonar {speed_of_sound: 1000, range: 20, bin_count: 200, beam_count: 1, field_of_view_deg: 2, beam_height_deg: 4, crosstalk: {}}}
  two_sonar: {type: sonar::SonarTask, properties: *sonar}
  log: {type: logger::LoggerTask, properties: {file: x.0.log}}
connections:
  - {from: one.pose, to: one_scene.pose}
  - {from: two.pose, to: two_scene.pose}
  - {from: one_scene.snapshot, to: one_sonar.snapshot}
  - {from: two_scene.snapshot, to: two_sonar.snapshot}
  - {from: one_sonar.transmission, to: two_sonar.others, policy: {type: circular_buffer, size: 8}}
  - {from: two_sonar.transmission, to: one_sonar.others, policy: {type: circular_buffer, size: 8}}
  - {from: one_sonar.ping, to: log.one, policy: {type: buffer, size: 8}}
  - {from: two_sonar.ping, to: log.two, policy: {type: buffer, size: 8}}
)";

struct CrosstalkRunTest : testing::Test {
    CrosstalkRunTest() {
        fs::copy_file(fs::path(insonify::test::source_dir) / "deploy/scenes/wall.glb", folder_ / "case.glb");
    }
    Outcome run(const std::string& deployment, std::vector<std::string> limits) {
        writeFile(folder_ / "pair.yml", deployment);
        std::vector<std::string> words{"run", "pair.yml", "--out", "out"};
        words.insert(words.end(), limits.begin(), limits.end());
        return callInsonify(folder_, words);
    }
    std::vector<Sonar> logged(const std::string& sonar) {
        return exportedPings(folder_, "out/x.0.log", sonar + "_sonar.ping");
    }

    const TestFolder folder_;
};

std::map<size_t, float> received(const Sonar& ping) {
    std::map<size_t, float> bins;
    for (size_t k = 0; k < ping.bins.size(); ++k)
        if (ping.bins[k] > 0) bins[k] = ping.bins[k];
    return bins;
}

}  // namespace

TEST_F(CrosstalkRunTest, PulsesOfTheOtherSonarArriveAtTheRightTimeAndLevel) {
    ASSERT_THAT(run(pair, {"--pings", "6"}), succeeds());
    const std::vector<Sonar> one = logged("one"), two = logged("two");
    ASSERT_GE(one.size(), 6u);
    ASSERT_GE(two.size(), 6u);
    for (size_t i = 0; i < 6; ++i) {
        const size_t late = 100 + 20 * i, early = 100 - 20 * i;  // 10 m, and 2 m for each ping
        const auto of_one = received(one[i]), of_two = received(two[i]);
        if (late < 200) {
            ASSERT_EQ(of_one.size(), 1u) << i;
            EXPECT_EQ(of_one.begin()->first, late) << i;
            EXPECT_NEAR(of_one.begin()->second, 1.0 / 400, 1e-6);
        } else {
            EXPECT_TRUE(of_one.empty()) << i;
        }
        if (i >= 5) continue;  // from then on a pulse of one is before two listens
        ASSERT_EQ(of_two.size(), 1u) << i;
        EXPECT_EQ(of_two.begin()->first, early) << i;
    }
}

TEST_F(CrosstalkRunTest, PingsWithoutAPulseEqualThoseWithoutCrosstalk) {
    const std::string looking = replaced(pair, "yaw_deg: 90}", "yaw_deg: 0}");  // one looks at the wall
    ASSERT_EQ(run(looking, {"--pings", "4"}).code, 0);
    const std::vector<Sonar> receiving = logged("one");
    std::string deaf = replaced(looking, "crosstalk: {}", "range_min: 0.1");
    deaf = replaced(
        deaf, "  - {from: one_sonar.transmission, to: two_sonar.others, policy: {type: circular_buffer, size: 8}}\n",
        "");
    deaf = replaced(
        deaf, "  - {from: two_sonar.transmission, to: one_sonar.others, policy: {type: circular_buffer, size: 8}}\n",
        "");
    ASSERT_EQ(run(deaf, {"--pings", "4"}).code, 0);
    const std::vector<Sonar> alone = logged("one");
    ASSERT_FALSE(received(alone[0]).empty());
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(receiving[i].time, alone[i].time);
        EXPECT_EQ(receiving[i].bins, alone[i].bins);
    }
}

TEST_F(CrosstalkRunTest, CrosstalkWorksInRealtime) {
    ASSERT_THAT(run("schedule: realtime\n" + std::string(pair), {"--duration", "2"}), succeeds());
    const std::vector<Sonar> one = logged("one");
    EXPECT_GE(one.size(), 15u);
    size_t receives = 0;
    for (const Sonar& ping : one)
        for (const auto& [bin, level] : received(ping)) {
            EXPECT_NEAR(level, 1.0 / 400, 1e-6);
            ++receives;
        }
    EXPECT_GE(receives, 2u);  // a pulse is received in a third of 20 pings
}

TEST_F(CrosstalkRunTest, RefusesWrongConnections) {
    Outcome outcome = run(replaced(pair, ", crosstalk: {}", ""), {"--pings", "2"});
    EXPECT_THAT(outcome, isRefused(testing::HasSubstr("others: is connected; the sonar does not receive other sonars: "
                                                      "give it `crosstalk: {}`")));
    std::string loop = replaced(pair, "one_sonar.others, policy: {type: circular_buffer, size: 8}", "one_sonar.others");
    loop = replaced(loop, "two_sonar.others, policy: {type: circular_buffer, size: 8}", "two_sonar.others");
    outcome = run(loop, {"--pings", "2"});
    EXPECT_THAT(outcome, isRefused(testing::HasSubstr("closes a loop without a buffer")));
    outcome = run(replaced(pair, "crosstalk: {}", "crosstalk: {rejection: 3}"), {"--pings", "2"});
    EXPECT_THAT(outcome,
                isRefused(testing::HasSubstr("crosstalk.rejection: is not a key here; did you mean rejection_db?")));
    outcome = run(replaced(pair, "crosstalk: {}", "crosstalk: {}, visibility: gl"), {"--pings", "2"});
    EXPECT_THAT(outcome, isRefused(testing::HasSubstr("visibility: is gl with crosstalk.echoes, which needs rays")));
    outcome = run(pair, {"--pings", "4", "--shard", "1/2"});
    EXPECT_THAT(outcome,
                isRefused(testing::HasSubstr("the sonar receives pings of other sonars, which a shard does not have")));
}
