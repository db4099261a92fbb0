// Warnings of runs whose sonar receives no echoes.
#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

namespace {

std::string reported(const std::vector<std::string>& settings) {
    const WallFolder folder;
    std::vector<std::string> words = {"--pings", "3"};
    for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
    const Outcome outcome = folder.run(words);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.err;
}

size_t count(const std::string& text, const std::string& part) {
    size_t times = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++times;
    return times;
}

}  // namespace

TEST(SilentRunTest, WarnsOnceWithThePositionLookDirectionAndBoundsOfTheScene) {
    const std::string text = reported({"sonar.range=5"});
    EXPECT_EQ(count(text, "warning: sonar: receives no echo"), 1u) << text;
    EXPECT_THAT(text, AllOf(HasSubstr("The sonar is at [0, 0, 0] and looks towards [1, 0, 0]"),
                            HasSubstr("the scene extends from [10, -20, -20] to [10, 20, 20]"),
                            HasSubstr("its nearest point 10 m away at [10, 0, 0] of wall: beyond the range of 5")));
}

TEST(SilentRunTest, NamesWhyTheNearestPointGivesNoEcho) {
    EXPECT_THAT(reported({"scene.mount={yaw_deg: 180}"}), HasSubstr("at a bearing of 180 deg to "));
    EXPECT_THAT(reported({"scene.mount={pitch_deg: 85}"}),
                AllOf(HasSubstr("85 deg down"), HasSubstr("85 deg above the sonar's plane")));
    EXPECT_THAT(reported({"sonar.range_min=19"}), HasSubstr("nearer than range_min, 19 m"));
}

TEST(SilentRunTest, SidelobesReceiveEchoesDownToTheFloor) {
    const std::string pattern =
        "sonar.beam_pattern={receive: {elevation: {weighting: gaussian, width_deg: 10}}, floor_db: ";
    const std::string up = "scene.mount={pitch_deg: 85}";
    EXPECT_THAT(reported({up, pattern + "-20}"}),
                AllOf(HasSubstr("85 deg above the sonar's plane, where the pattern reaches floor_db 1"),
                      HasSubstr(" deg to either side")));
    EXPECT_THAT(
        reported({"scene.mount={yaw_deg: 100}",
                  "sonar.beam_pattern={receive: {azimuth: {weighting: gaussian, width_deg: 4}}, floor_db: -20}"}),
        AllOf(HasSubstr("at a bearing of 100 deg to starboard, where the patterns are above floor_db from 3"),
              HasSubstr(" deg to port to 3")));
    EXPECT_THAT(reported({"scene.mount={yaw_deg: 45}",
                          "sonar.beam_pattern={receive: {azimuth: {weighting: uniform, width_deg: 4}}}"}),
                Not(HasSubstr("receives no echo")))
        << "the wall's echo is received by sidelobes";
}

TEST(SilentRunTest, NamesAMaterialWithoutBackscatter) {
    EXPECT_THAT(reported({"sonar.model=cerqueira2017", "scene.materials={wall: {reflectivity: 0}}"}),
                AllOf(HasSubstr("its nearest point 10 m away at [10, 0, 0] of wall: its material '"),
                      HasSubstr("' has reflectivity 0 and returns no echo")));
    EXPECT_THAT(
        reported({"scene.materials={wall: {lambert_db: -200}}"}),
        AllOf(HasSubstr("of wall: its material '"), HasSubstr("', of lambert_db -200 dB, returns no detectable echo")));
}

TEST(SilentRunTest, NamesATargetBehindTheWall) {
    EXPECT_THAT(reported({"sonar.range=5",
                          "scene.targets=[{name: buoy, position: [0, 4, 0], strength_db: 0}, "
                          "{name: far, position: [9, 0, 0], strength_db: 0}]"}),
                HasSubstr("; its nearest target 4 m away at [0, 4, 0], buoy: at a bearing of 90 deg to port, where the "
                          "fan covers from 30 deg to port to 30 deg to starboard"));
    EXPECT_THAT(reported({"sonar.range=5", "scene.targets=[{name: buoy, position: [4, 0, 0], strength_db: 0}]"}),
                Not(HasSubstr("receives no echo")));
}

TEST(SilentRunTest, WarnsOnceOfASonarInsideAClosedMesh) {
    const WallFolder folder;
    writeFile(folder / "wall.gltf",
              makeGltf({-2, -2, -2, 2, -2, -2, 2, 2, -2, -2, 2, -2, -2, -2, 2, 2, -2, 2, 2, 2, 2, -2, 2, 2},
                       {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                        1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7}));
    const std::string text = folder.run({"--pings", "3"}).err;
    EXPECT_EQ(count(text,
                    "warning: sonar: is inside of wall, which has its faces outward: the sonar is at [0, 0, 0], its "
                    "nearest surface 2 m away at ["),
              1u)
        << text;
    EXPECT_THAT(text, Not(HasSubstr("receives no echo")));
}

TEST(SilentRunTest, ARunWithEchoesPrintsNothing) { EXPECT_THAT(reported({}), Not(HasSubstr("receives no echo"))); }

TEST(SilentRunTest, WaitsForAFullTurnOfAHead) {
    const std::string scanning = replaced(replaced(wall_deployment, "sonar::SonarTask", "sonar::ScanningSonarTask"),
                                          "      beam_count: 16\n      bin_count: 50\n      field_of_view_deg: 60\n    "
                                          "  beam_height_deg: 10\n      quality: {rows: 32, columns_per_beam: 2}\n",
                                          "      head: {step_deg: 36}\n");
    const WallFolder receives(scanning), deaf(replaced(scanning, "range: 20", "range: 5"));
    EXPECT_THAT(receives.run({"--pings", "10"}).err, Not(HasSubstr("receives no echo")));
    EXPECT_THAT(deaf.run({"--pings", "9"}).err, Not(HasSubstr("receives no echo")));
    EXPECT_THAT(deaf.run({"--pings", "10"}).err, HasSubstr("receives no echo"));
}
