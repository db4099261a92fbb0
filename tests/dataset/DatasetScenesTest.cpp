// insonify dataset: poses of a trajectory, scenes of their own, and what records say of objects.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>
#include <set>

#include "components/pose/SeaMotion.hpp"
#include "tests/dataset/DatasetFolder.hpp"

using namespace insonify::deployer;
using insonify::dataset::deployment;
using testing::HasSubstr;
using testing::IsEmpty;

namespace {

struct DatasetScenesTest : insonify::dataset::DatasetFolder {};

}  // namespace

TEST_F(DatasetScenesTest, PosesOfATrajectoryGiveTracks) {
    writeFile(folder_ / "sweep.yml",
              "poses:\n  trajectory: {file: " + (root / "deploy/scenes/harbour_pass.csv").string() +
                  ", count: 4, to: 6}\nclasses: {pile: pile_*}\npicture: {shape: polar}\n");
    ASSERT_EQ(make("out").code, 0);
    std::istringstream lines(readFile(folder_ / "out/tracks_000_000.txt"));
    std::map<std::string, std::set<std::string>> frames;  // by object
    std::string frame, object, rest;
    while (std::getline(lines, frame, ',') && std::getline(lines, object, ',') && std::getline(lines, rest)) {
        frames[object].insert(frame);
        EXPECT_THAT(rest, testing::MatchesRegex("[0-9]+,[0-9]+,[0-9]+,[0-9]+,1,1,1"));
    }
    EXPECT_GT(frames.size(), 1u);
    EXPECT_TRUE(std::ranges::any_of(frames, [](const auto& of) { return of.second.size() > 1; }));
    EXPECT_EQ(makeRecord("out", "000003")["time_s"], 6);
    EXPECT_EQ(makeRecord("out", "000003")["picture"]["width"], 128);
}

TEST_F(DatasetScenesTest, PosesOfATrajectoryMoveOnWavesAsTheTaskMovesThem) {
    writeFile(folder_ / "path.csv", "time,x,y,z,qw,qx,qy,qz\n0,4,-4,-5.5,1,0,0,0\n4,8,-4,-5.5,1,0,0,0\n");
    writeFile(folder_ / "sweep.yml",
              "poses:\n  trajectory: {file: path.csv, count: 3, motion: {heave_m: 0.3, roll_deg: 5, seed: 3}}\n");
    ASSERT_EQ(make("out").code, 0);
    const insonify::pose::SeaMotion motion({.heave_m = 0.3, .roll_deg = 5, .seed = 3});
    for (int i = 0; i < 3; ++i) {
        insonify::types::Pose pose;
        pose.position = {4 + 2 * i, -4, -5.5};
        motion.move(2 * i, pose);
        const json position = makeRecord("out", "00000" + std::to_string(i))["pose"]["position"];
        EXPECT_NEAR(position[2].get<double>(), pose.position.z, 1e-6) << i;
    }
    writeFile(folder_ / "sweep.yml", "poses:\n  trajectory: {file: path.csv, count: 3, motion: {seed: 3}}\n");
    EXPECT_THAT(make("out"), isRefused(HasSubstr("moves nothing; give heave_m, roll_deg or pitch_deg")));
}

TEST_F(DatasetScenesTest, PosesOfATrajectoryAreFromItsFirstStampToItsLast) {
    writeFile(folder_ / "path.csv", "time,x,y,z,qw,qx,qy,qz\n100,4,-4,-5.5,1,0,0,0\n102,8,-4,-5.5,1,0,0,0\n");
    const auto make = [&](const std::string& times) {
        writeFile(folder_ / "sweep.yml", "poses:\n  trajectory: {file: path.csv, count: 3" + times + "}\n");
        return DatasetFolder::make("out");
    };
    const std::string place = "sweep.yml:2:15: poses.trajectory.";
    EXPECT_THAT(make(", from: 2"), isRefused(HasSubstr(place + "from: is 2 s; the trajectory is from 100 to 102 s")));
    EXPECT_THAT(make(", to: 103"), isRefused(HasSubstr(place + "to: is 103 s; the trajectory is from 100 to 102 s")));
    ASSERT_EQ(make("").code, 0);
    for (int i = 0; i < 3; ++i) {
        const json record = makeRecord("out", "00000" + std::to_string(i));
        EXPECT_EQ(record["time_s"], 100 + i);
        EXPECT_EQ(record["pose"]["position"][0], 4 + 2 * i);
    }
}

TEST_F(DatasetScenesTest, TheFloorOfASurveyIsAScene) {
    const std::string file = (root / "deploy/scenes/harbour.glb").string(),
                      survey = (root / "deploy/scenes/bay.flt").string();
    writeFile(folder_ / "d.yml", replaced(deployment, "file: " + file, "bathymetry: {file: " + survey + "}"));
    writeFile(folder_ / "sweep.yml", "poses: {grid: {z: [-11, -10]}}\n");
    ASSERT_THAT(make("out"), succeeds());
    for (const char* index : {"000000", "000001"}) {
        const json record = makeRecord("out", index);
        EXPECT_EQ(record["scene"], "bathymetry");
        EXPECT_THAT(record["annotations"], IsEmpty());
    }
    EXPECT_THAT(json::parse(readFile(folder_ / "out/manifest.json"))["classes"], IsEmpty());
    writeFile(folder_ / "sweep.yml", "poses: {grid: {z: -11}}\nclasses: {rock: rock_*}\n");
    EXPECT_THAT(make("none").err,
                HasSubstr("sweep.yml:2:11: classes.rock[0]: is rock_*, which is no name in the scene"));
}

TEST_F(DatasetScenesTest, ScenesHaveFilesAndPropertiesOfTheirOwn) {
    writeFile(folder_ / "sweep.yml", "scenes: [" + (root / "deploy/scenes/tank.glb").string() +
                                         ", {set: {sonar.bin_count: 100}}]\nposes: {grid: {z: -3}}\n");
    ASSERT_EQ(make("out").code, 0);
    const json first = makeRecord("out", "000000"), second = makeRecord("out", "000001");
    EXPECT_EQ(first["scene"], "tank.glb");
    EXPECT_EQ(first["ping"]["bins"], 200);
    EXPECT_EQ(second["scene"], "harbour.glb");
    EXPECT_EQ(second["ping"]["bins"], 100);
    const json classes = json::parse(readFile(folder_ / "out/manifest.json"))["classes"];
    EXPECT_THAT(classes, testing::IsSupersetOf({json("pillar"), json("pile"), json("sea_floor")}));
}

TEST_F(DatasetScenesTest, APatternOfObjectsMayMatchInOneOfTheScenesAlone) {
    const std::string scenes = "scenes: [" + (root / "deploy/scenes/harbour.glb").string() + ", " +
                               (root / "deploy/scenes/tank.glb").string() + "]\nposes: {grid: {x: 5, z: -3}}\n";
    writeFile(folder_ / "sweep.yml", scenes +
                                         "objects: [{names: [rock_000, pillar*], x: [6, 20], y: [-8, 8], avoid: "
                                         "[quay_wall]}]\n");
    ASSERT_THAT(make("out"), succeeds());
    const json harbour = makeRecord("out", "000000")["objects"], tank = makeRecord("out", "000001")["objects"];
    ASSERT_EQ(harbour.size(), 1u);
    EXPECT_EQ(harbour[0]["name"], "rock_000");
    for (const json& each : tank) EXPECT_THAT(each["name"].get<std::string>(), testing::StartsWith("pillar"));
    EXPECT_FALSE(tank.empty());
    writeFile(folder_ / "sweep.yml", scenes + "objects: [{names: [rock_000, pilar*], x: [6, 20], y: [-8, 8]}]\n");
    EXPECT_THAT(
        make("none"),
        isRefused(HasSubstr("sweep.yml:3:11: objects[0].names[1]: is pilar*, which is no name in any of the scenes")));
}

TEST_F(DatasetScenesTest, ObjectsEchoFromTheirPlaces) {
    writeFile(folder_ / "sweep.yml", R"(poses: {grid: {x: 5, y: -30, z: -5.5, yaw_deg: [0, 90]}}
objects: [{names: [rock_000], x: [12, 12.001], y: [2, 2.001], frame: vehicle, ground: sea_floor}]
classes: {rock: rock_000}
)");
    ASSERT_EQ(make("out").code, 0);
    for (const char* index : {"000000", "000001"}) {
        const json record = makeRecord("out", index);
        ASSERT_EQ(record["annotations"].size(), 1u) << index;
        const json& found = record["annotations"][0];
        EXPECT_EQ(found["name"], "rock_000");
        const double bearing = std::atan2(2, 12 - 0.4);
        EXPECT_LT(found["bearing_rad"][0], bearing);
        EXPECT_GT(found["bearing_rad"][1], bearing);
        EXPECT_LT(found["range_m"][0], std::hypot(11.6, 2, 3.5));
        EXPECT_GT(found["range_m"][1], std::hypot(11.6, 2, 3.5) - 1);
    }
}

TEST_F(DatasetScenesTest, RangesInARecordAreThoseOfTheSonarAtAnyRounding) {
    writeFile(folder_ / "sweep.yml", R"(poses: {grid: {x: 5, y: -30, z: -5.5}}
settings:
  sonar.range: [6.3]
  sonar.range_rounding: [sample, exact]
  sonar.range_min: [0, 2]
  sonar.bin_count: [100, 375, 1000]
objects: [{names: [rock_000], x: [5, 5.001], y: [0, 0.001], z: [-6.5, -6.499], frame: vehicle}]
classes: {rock: rock_000}
)");
    ASSERT_EQ(make("out").code, 0);
    double nearest = 0;
    for (int i = 0; i < 12; ++i) {
        const json record = makeRecord("out", fmt::format("{:06}", i));
        const double c = record["ping"]["speed_of_sound_m_s"], bins = record["ping"]["bins"];
        const bool exact = record["settings"]["sonar.range_rounding"] == "exact";
        const double range = exact ? 6.3 : bins * std::ceil(6.3 / bins / c * 1e6) * 1e-6 * c;
        EXPECT_NEAR(record["ping"]["range_m"], range, 1e-9) << i;
        ASSERT_EQ(record["annotations"].size(), 1u) << i;
        const double near = record["annotations"][0]["range_m"][0], cell = range / 100;
        if (i == 2) nearest = near;  // the finest of bins of whole microseconds
        if (i > 2) {
            EXPECT_NEAR(near, nearest, 2 * cell) << i;
        }
    }
    EXPECT_NEAR(nearest, std::hypot(4.6, 0.8), 1);
}

TEST_F(DatasetScenesTest, TheHeightOfAnObjectSetsTheLengthOfItsShadow) {
    writeFile(folder_ / "sweep.yml", R"(poses: {grid: {x: 5, y: -30, z: -5.5, yaw_deg: [0, 90]}}
objects: [{names: [rock_000], x: [10, 10.001], y: [1, 1.001], frame: vehicle, ground: sea_floor}]
classes: {rock: rock_000}
annotations: {shadows: true}
)");
    ASSERT_EQ(make("out").code, 0);
    EXPECT_EQ(json::parse(readFile(folder_ / "out/manifest.json"))["classes"], json::array({"rock", "rock_shadow"}));
    for (const char* index : {"000000", "000001"}) {
        const json record = makeRecord("out", index);
        ASSERT_EQ(record["annotations"].size(), 2u) << index;
        const json &rock = record["annotations"][0], &shadow = record["annotations"][1];
        EXPECT_EQ(rock["shadow"], false);
        EXPECT_EQ(shadow["shadow"], true);
        EXPECT_EQ(shadow["name"], "rock_000");
        EXPECT_EQ(shadow["class"], "rock_shadow");
        EXPECT_GE(shadow["range_m"][0], rock["range_m"][0]);
        EXPECT_GT(shadow["range_m"][1], rock["range_m"][1]);
        EXPECT_GE(shadow["bearing_rad"][0].get<double>(), rock["bearing_rad"][0].get<double>() - 0.02);
        EXPECT_LE(shadow["bearing_rad"][1].get<double>(), rock["bearing_rad"][1].get<double>() + 0.02);
    }
}
