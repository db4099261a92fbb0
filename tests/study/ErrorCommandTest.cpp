#include <gmock/gmock.h>

#include <algorithm>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

TEST(ErrorCommandTest, WritesTablesAndJson) {
    const WallFolder folder;
    const Outcome outcome = callInsonify(
        folder, {"study", "error", "--scene", "flat_bottom", "--levels", "2", "--pings", "2", "--out", "report"});
    EXPECT_THAT(outcome, prints(HasSubstr("flat_bottom: slope of footprints over cells")))
        << outcome.out << outcome.err;
    const json report = json::parse(readFile(folder / "report/error_time.json"));
    EXPECT_EQ(report["references"][0]["source"], "closed form");
    EXPECT_LT(report["points"][0]["rel_l2"], 1e-3);
    for (const char* method : {"footprint", "nearest", "nearest_jitter", "published", "embree"}) {
        const auto found =
            std::ranges::find(report["methods"], method, [](const json& each) { return each["method"]; });
        ASSERT_NE(found, report["methods"].end()) << method;
        EXPECT_EQ((*found)["points"].size(), 2u) << method;
        for (const char* goal : {"10", "1", "0.3", "0.1"})
            for (const char* ending : {"", "_is", "_open", "_without_gain", "_without_gain_is", "_without_gain_open"})
                EXPECT_TRUE(found->contains("ms_to_" + std::string(goal) + "_percent" + ending)) << goal << ending;
    }
    const std::string sheet = readFile(folder / "report/error_time.md");
    for (const char* table :
         {"References", "Time of a ping to an error", "Error as a control", "Claims", "Every point"})
        EXPECT_THAT(sheet, HasSubstr(std::string("## ") + table + "\n"));
}

TEST(ErrorCommandTest, StudiesADeploymentAgainstBruteForceThatMayBeTooCoarse) {
    const WallFolder folder;
    const Outcome outcome = callInsonify(folder, {"study", "error", "wall.yml", "--levels", "2", "--pings", "1",
                                                  "--reference-rays", "1e5", "--out", "report"});
    EXPECT_THAT(outcome, prints(AllOf(HasSubstr("open  deployment_wall: smallest error over that of the reference"),
                                      HasSubstr("nothing is wrong with the scene"))))
        << outcome.out << outcome.err;
    const json report = json::parse(readFile(folder / "report/error_time.json"));
    ASSERT_EQ(report["references"].size(), 1u);
    EXPECT_EQ(report["references"][0]["scene"], "deployment_wall") << "wall is a scene of the study";
    EXPECT_THAT(report["references"][0]["source"].get<std::string>(), HasSubstr("brute force"));
    EXPECT_GT(report["references"][0]["error"], 0);
    for (const json& point : report["points"])
        EXPECT_TRUE(point["method"] != "footprint" || point["rel_l2"] < 0.02) << point;
}

TEST(ErrorCommandTest, ReportsTimesOfRaysForAnyDeployment) {
    const WallFolder folder;
    const Outcome outcome = callInsonify(folder, {"study", "rays", "wall.yml", "--pings", "3"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json times = json::parse(outcome.out);
    EXPECT_GT(times["rays"], 0);
    EXPECT_EQ(times["met"], times["rays"]) << "the wall fills the fan";
    EXPECT_GT(times["alone_median_ms"], 0);
    EXPECT_GE(times["alone_p99_ms"], times["alone_median_ms"]);
    EXPECT_GT(times["ping_median_ms"], 0);
}

TEST(ErrorCommandTest, RefusesUnsuitableDeployments) {
    const WallFolder folder;
    Outcome outcome = callInsonify(folder, {"study", "error", "--scene", "moon", "--out", "report"});
    EXPECT_THAT(outcome, isRefused(HasSubstr("moon is not a scene of the study; those are flat_bottom, ")));
    std::string conical = wall_deployment;
    conical.insert(conical.find("range: "), "beam_geometry: conical\n      ");
    writeFile(folder / "conical.yml", conical);
    outcome = callInsonify(folder, {"study", "error", "conical.yml", "--out", "report"});
    EXPECT_THAT(outcome, isRefused(HasSubstr("conical beams")));
    outcome = callInsonify(folder, {"study", "error", "missing.yml", "--out", "report"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_FALSE(fs::exists(folder / "report")) << "nothing is written";
}
