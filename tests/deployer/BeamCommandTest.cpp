#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using ::testing::HasSubstr;

namespace {

/** Returns a deployment with these additional properties of the sonar. */
std::string sonarWith(const std::string& properties) {
    return R"(tasks:
  vehicle: {type: pose::TrajectoryTask, activity: {period: 0.1}, properties: {waypoints: [{time: 0, position: [0, 0, 0]}]}}
  scene:   {type: scene::SceneTask, properties: {file: wall.gltf}}
  sonar:   {type: sonar::SonarTask, properties: {beam_count: 64, field_of_view_deg: 64)" +
           (properties.empty() ? "" : ", " + properties) + R"(}}
connections: [{from: vehicle.pose, to: scene.pose}, {from: scene.snapshot, to: sonar.snapshot}]
)";
}

struct BeamCommandTest : testing::Test {
    Outcome call(const std::string& properties, std::vector<std::string> options) {
        writeFile(folder_ / "wall.gltf", wallGltf());
        writeFile(folder_ / "sonar.yml", sonarWith(properties));
        options.insert(options.begin(), {"beam", "sonar.yml"});
        return callInsonify(folder_, options);
    }
    json getCuts(const std::string& properties) {
        const Outcome outcome = call(properties, {"--json"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return json::parse(outcome.out);
    }

    TestFolder folder_;
};

TEST_F(BeamCommandTest, PrintsWidthFirstNullAndSidelobesTwoWay) {
    const json cuts = getCuts(
        "beam_pattern: {transmit: {elevation: {width_deg: 12}}, "
        "receive: {azimuth: {weighting: hann, width_deg: 1.5}, elevation: {width_deg: 12}}}");
    const json& azimuth = cuts["azimuth"];
    EXPECT_NEAR(azimuth["width_3db_deg"], 1.5, 0.01) << "transmitted equally in all directions";
    EXPECT_NEAR(azimuth["first_null_deg"], 1.5 * 2 / 1.4406, 0.02);
    EXPECT_NEAR(azimuth["peak_sidelobe_db"], -31.5, 0.1);
    const json& elevation = cuts["elevation"];
    EXPECT_NEAR(elevation["width_3db_deg"], 12 * 0.6378 / 0.8859, 0.05) << "transmitted and received";
    EXPECT_NEAR(elevation["peak_sidelobe_db"], -26.5, 0.1);
    for (const char* axis : {"azimuth", "elevation"}) {
        ASSERT_EQ(cuts[axis]["angle_deg"].size(), cuts[axis]["level_db"].size());
        EXPECT_GT(cuts[axis]["angle_deg"].size(), 20u);
        EXPECT_LT(*std::max_element(cuts[axis]["level_db"].begin(), cuts[axis]["level_db"].end()), 0.01);
    }
}

TEST_F(BeamCommandTest, WithoutAPatternABeamIsABox) {
    const json cuts = getCuts("beam_height_deg: 14");
    EXPECT_NEAR(cuts["azimuth"]["width_3db_deg"], 1, 1e-9);
    EXPECT_NEAR(cuts["elevation"]["width_3db_deg"], 14, 1e-9);
    EXPECT_TRUE(cuts["azimuth"]["peak_sidelobe_db"].is_null());
    EXPECT_THAT(cuts["azimuth"]["level_db"], testing::ElementsAre(0, 0));
}

TEST_F(BeamCommandTest, ASideScanHasTheAxesOfItsProperties) {
    writeFile(folder_ / "wall.gltf", wallGltf());
    writeFile(folder_ / "abeam.yml",
              replaced(sonarWith(""), "sonar::SonarTask, properties: {beam_count: 64, field_of_view_deg: 64}",
                       "sonar::SideScanTask, properties: {beam_width_deg: 0.5, beam_height_deg: 60, beam_pattern: "
                       "{receive: {elevation: {width_deg: 50}}}}"));
    const Outcome outcome = callInsonify(folder_, {"beam", "abeam.yml", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json cuts = json::parse(outcome.out);
    EXPECT_NEAR(cuts["azimuth"]["width_3db_deg"], 0.5, 1e-6) << "along the track";
    EXPECT_NEAR(cuts["elevation"]["width_3db_deg"], 50, 0.1) << "across it";
}

TEST_F(BeamCommandTest, ReportsWhatCannotBeShown) {
    const Outcome set = call("beam_height_deg: 14", {"--set", "sonar.beam_height_deg=9", "--json"});
    ASSERT_EQ(set.code, 0) << set.err;
    EXPECT_NEAR(json::parse(set.out)["elevation"]["width_3db_deg"], 9, 1e-9);
    EXPECT_THAT(call("", {"--set", "sonar.beam_hight_deg=9"}), isRefused(HasSubstr("did you mean beam_height_deg?")));
    writeFile(folder_ / "none.yml",
              "tasks: {vehicle: {type: pose::TrajectoryTask, activity: {period: 0.1}, properties: {waypoints: [{time: "
              "0, position: [0, 0, 0]}]}}}\n");
    EXPECT_THAT(callInsonify(folder_, {"beam", "none.yml"}), isRefused(HasSubstr("none.yml: has no sonar")));
    EXPECT_THAT(call("", {"--task", "sona"}), isRefused(HasSubstr("may be sonar")));
    EXPECT_THAT(call("beam_pattern: {receive: {azimuth: {file: none.csv}}}", {}), isRefused(HasSubstr("none.csv")));
    writeFile(folder_ / "table.csv", "angle_deg,level_db\n0,0\n1,abc\n");
    EXPECT_THAT(call("beam_pattern: {receive: {azimuth: {file: table.csv}}}", {}),
                isRefused(HasSubstr("table.csv:3:3")));
}

}  // namespace
