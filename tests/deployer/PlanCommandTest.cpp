#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

TEST(PlanCommandTest, JsonHasRunAndOmittedFeatures) {
    const WallFolder folder;
    const json plan = makeJson(folder, {"plan", "wall.yml"});
    EXPECT_TRUE(plan["features"].is_array());
    EXPECT_FALSE(plan["passes"].empty());
    ASSERT_FALSE(plan["omitted"].empty());
    for (const json& omitted : plan["omitted"]) {
        EXPECT_NE(omitted["name"], "");
        EXPECT_NE(omitted["reason"], "");
    }
    EXPECT_EQ(plan["quality"]["rows"], 32);
    EXPECT_EQ(plan["quality"]["columns_per_beam"], 2);
    EXPECT_EQ(plan["quality"]["slabs"], 0) << "rays need no images";
    EXPECT_TRUE(plan["quality"].contains("predicted_error"));
    EXPECT_NE(plan["device"], "");
}

TEST(PlanCommandTest, TheTextNamesEachOmissionWithItsReason) {
    const WallFolder folder;
    ASSERT_THAT(callInsonify(folder, {"plan", "wall.yml"}),
                prints(AllOf(HasSubstr("sonar\n  quality: 32 rows, 2 columns per beam, by rays on the processor\n"),
                             HasSubstr("  omitted: motion within a ping: motion_in_ping is false; from "))));
    const Outcome slow = callInsonify(folder, {"plan", "wall.yml", "--set", "sonar.speed_of_sound=1000"});
    EXPECT_THAT(slow.out, HasSubstr("  warning: speed of sound is 1000 m/s; water has 1350 to 1650"));
}

TEST(PlanCommandTest, TruthIsOmittedUnlessTheDeploymentConnectsIt) {
    const std::string ping = "  - {from: sonar.ping, to: log.clean, policy: {type: buffer, size: 64}}\n";
    const auto printed = [](const std::string& deployment) {
        const WallFolder folder(deployment);
        const Outcome outcome = callInsonify(folder, {"plan", "wall.yml"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome.out;
    };
    const auto omitted = HasSubstr("omitted: truth: nobody is connected");
    EXPECT_THAT(printed(wall_deployment), omitted);
    for (const std::string port : {"truth", "returns"}) {
        const std::string reader = "  - {from: sonar." + port + ", to: log." + port + "}\n";
        EXPECT_THAT(printed(replaced(wall_deployment, ping, ping + reader)), testing::Not(omitted)) << port;
    }
}

TEST(PlanCommandTest, AWallNearAHalfWaveIsAWarning) {
    const TestFolder folder;
    const std::string deployment = insonify::test::sourceFile("deploy/vessels.yml");
    const auto plan = [&](const char* thickness_mm, const char* fill) {
        return callInsonify(folder, {"plan", deployment, "--set", "sonar.frequency_khz=3000", "--set",
                                     fmt::format("scene.materials={{glass bottle: {{shell: {{material: pvc, "
                                                 "thickness_mm: {}, fill: {}}}}}}}",
                                                 thickness_mm, fill)})
            .out;
    };
    const auto warns = HasSubstr(
        "warning: the wall of glass bottle is near a half-wave resonance: 0.41 mm are 1.02 "
        "half wavelengths at 3000 kHz; it reflects ");
    EXPECT_THAT(plan("0.41", "water"), warns);
    EXPECT_THAT(plan("0.41", "air"), testing::Not(HasSubstr("resonance")));
    EXPECT_THAT(plan("0.3", "water"), testing::Not(HasSubstr("wall of glass bottle")));
}

TEST(PlanCommandTest, SetChangesThePlan) {
    const WallFolder folder;
    const json plan = makeJson(folder, {"plan", "wall.yml", "--set", "sonar.quality.rows=48"});
    EXPECT_EQ(plan["quality"]["rows"], 48);
}

TEST(PlanCommandTest, NothingIsWritten) {
    const WallFolder folder;
    ASSERT_EQ(callInsonify(folder, {"plan", "wall.yml"}).code, 0);
    EXPECT_FALSE(fs::exists(folder / "out"));
    EXPECT_FALSE(fs::exists(folder / "wall.0.log"));
}

TEST(PlanCommandTest, SeveralSonarsArePrintedByName) {
    std::string two =
        replaced(wall_deployment, "  noise:\n",
                 "  second: {type: sonar::SonarTask, properties: {beam_count: 8, bin_count: 20}}\n  noise:\n");
    two = replaced(two, "  - {from: sonar.ping, to: noise.clean}\n",
                   "  - {from: sonar.ping, to: noise.clean}\n  - {from: scene.snapshot, to: second.snapshot}\n");
    const WallFolder folder(two);
    const json plans = makeJson(folder, {"plan", "wall.yml"});
    EXPECT_EQ(plans["sonar"]["quality"]["rows"], 32);
    EXPECT_TRUE(plans.contains("second"));
}

TEST(PlanCommandTest, ADeploymentWithoutASonarHasNoPlan) {
    const WallFolder folder(
        "schedule: lockstep\ntasks:\n  vehicle: {type: pose::TrajectoryTask, activity: {period: 0.1}, properties: "
        "{waypoints: [{time: 0, position: [0, 0, 0], roll_deg: 0, pitch_deg: 0, yaw_deg: 0}]}}\n");
    EXPECT_THAT(callInsonify(folder, {"plan", "wall.yml"}), isRefused(HasSubstr("no sonar")));
}
