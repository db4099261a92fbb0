// insonify dataset: waterfalls of a side-scan over rocks at known places.
#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "tests/deployer/Command.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

const std::string side_scan = R"(schedule: lockstep
tasks:
  vehicle:
    type: pose::TrajectoryTask
    activity: {period: 0.1}
    properties: {waypoints: [{time: 0, position: [0, 0, 0]}]}
  scene: {type: scene::SceneTask, properties: {file: )" +
                              insonify::test::sourceFile("deploy/scenes/harbour.glb") + R"(}}
  sonar:
    type: sonar::SideScanTask
    properties: {range: 20, bin_count: 400, beam_width_deg: 1, beam_height_deg: 70, depression_deg: 40,
      quality: {rows: 4, columns_per_beam: 512}}
connections:
  - {from: vehicle.pose, to: scene.pose}
  - {from: scene.snapshot, to: sonar.snapshot}
)";

constexpr double speed = 1.5, period = 0.1;  // [m/s], [s]
constexpr double rock_size = 1.5;            // from the origin of a rock to its nearest point [m]
constexpr int lines = 120;

const std::string sweep_of_lines = R"(seed: 5
poses: {grid: {x: 2, y: -14, z: -5, yaw_deg: [0, 5]}}
lines: {count: 120, period: 0.1, speed: 1.5}
objects:
  - {names: [rock_00*], count: [6, 8], x: [3, 15], y: [-9, 9], frame: vehicle, ground: sea_floor, gap: 0.5,
     avoid: [quay_wall, hull, mooring_block, pile_*]}
classes: {rock: rock_00*}
picture: {shape: waterfall, height: 400}
annotations: {min_pixels: 4, shadows: true}
)";

struct WaterfallTest : testing::Test {
    WaterfallTest() {
        writeFile(folder_ / "d.yml", side_scan);
        writeFile(folder_ / "sweep.yml", sweep_of_lines);
    }
    std::map<std::string, std::string> made(const std::string& out, std::vector<std::string> more = {}) const {
        std::vector<std::string> all = {"dataset", "d.yml", "--sweep", "sweep.yml", "--out", out};
        all.insert(all.end(), more.begin(), more.end());
        EXPECT_THAT(callInsonify(folder_, all), succeeds());
        std::map<std::string, std::string> files;
        for (const auto& entry : fs::directory_iterator(folder_ / out))
            files[entry.path().filename()] = readFile(entry.path());
        return files;
    }

    const TestFolder folder_;
};

/** A rock abeam of line k at a slant range r is in row `lines - 1 - k`, r / range from the middle, on its side. */
TEST_F(WaterfallTest, EachRockIsWhereTheVehiclePassedIt) {
    size_t rocks = 0, shadows = 0;
    for (const auto& [name, bytes] : made("out")) {
        if (!name.ends_with(".json") || !name.starts_with("00")) continue;
        const json record = json::parse(bytes);
        EXPECT_EQ(record["ping"]["lines"], lines);
        EXPECT_EQ(record["ping"]["beams"], 2);
        EXPECT_EQ(record["picture"]["height"], lines);
        EXPECT_EQ(record["picture"]["width"], 800);
        std::map<std::string, json> placed;
        for (const json& object : record["objects"]) placed[object["name"]] = object;
        const json& q = record["pose"]["orientation_wxyz"];
        const double yaw = 2 * std::atan2(q[3].get<double>(), q[0].get<double>());
        for (const json& each : record["annotations"]) {
            const json &at = placed.at(each["name"])["position"], &from = record["pose"]["position"],
                       &box = each["bbox"];
            const double x = at[0].get<double>() - from[0].get<double>(),
                         y = at[1].get<double>() - from[1].get<double>(),
                         z = at[2].get<double>() - from[2].get<double>();
            const double ahead = x * std::cos(yaw) + y * std::sin(yaw), port = y * std::cos(yaw) - x * std::sin(yaw);
            const double row = lines - 1 - ahead / (speed * period);
            const double near = box[0].get<double>(), far = near + box[2].get<double>();
            const double slack = 2 + 1 / (speed * period);  // a rock measures one metre
            EXPECT_NEAR(box[1].get<double>() + box[3].get<double>() / 2, row, slack) << each["name"];
            const double sign = port > 0 ? -1 : 1;
            const double inner = sign * ((sign > 0 ? near : far) - 400) / 400 * 20;  // slant range [m]
            if (each["shadow"].get<bool>()) {
                ++shadows;
                EXPECT_GT(inner, std::hypot(port, z) - rock_size) << each["name"] << " shadow";
                continue;
            }
            ++rocks;
            EXPECT_NEAR(inner, std::hypot(port, z), rock_size) << each["name"];
        }
    }
    std::cout << rocks << " rocks, " << shadows << " shadows\n";
    EXPECT_GE(rocks, 6u);
    EXPECT_GE(shadows, 4u);
}

TEST_F(WaterfallTest, TheBytesDoNotDependOnTheProcess) {
    std::string text = sweep_of_lines;
    writeFile(folder_ / "sweep.yml", text.replace(text.find("count: 120"), 10, "count: 12"));
    for (const char* format : {"yolo", "mcap"}) {
        const std::string one = std::string("one_") + format, two = std::string("two_") + format;
        made(two, {"--format", format, "--shard", "1/2"});
        EXPECT_EQ(made(two, {"--format", format, "--shard", "0/2"}), made(one, {"--format", format})) << format;
    }
}

/** Rocks of twice the size give boxes of about twice the number of lines. */
TEST_F(WaterfallTest, ScaledObjectsHaveTheRecordedSize) {
    std::map<std::string, double> lines_of[2];
    for (const int large : {0, 1}) {
        std::string text = sweep_of_lines;
        text.replace(text.find("gap: 0.5"), 8, large ? "gap: 0.5, scale: [2, 2]" : "gap: 1.5");
        text.replace(text.find("count: [6, 8]"), 13, "count: [3, 3]");
        writeFile(folder_ / "sweep.yml", text);
        for (const auto& [name, bytes] : made(large ? "large" : "small")) {
            if (!name.ends_with(".json") || !name.starts_with("00")) continue;
            const json record = json::parse(bytes);
            for (const json& object : record["objects"])
                EXPECT_EQ(object.value("scale", 0), object["present"].get<bool>() ? (large ? 2 : 1) : 0);
            for (const json& each : record["annotations"])
                if (!each["shadow"].get<bool>()) lines_of[large][each["name"]] = each["bbox"][3].get<double>();
        }
    }
    double small = 0, large = 0;
    for (const auto& [name, count] : lines_of[0])
        if (lines_of[1].contains(name)) small += count, large += lines_of[1][name];
    std::cout << "lines of rocks: " << small << ", of twice their size: " << large << "\n";
    ASSERT_GT(small, 0);
    EXPECT_NEAR(large / small, 2, 0.5);
}

/** Along a trajectory, a run continues from its pose and must end before the trajectory. */
TEST_F(WaterfallTest, ARunFollowsATrajectory) {
    writeFile(folder_ / "t.csv", "time,x,y,z,qw,qx,qy,qz\n0,2,-14,-5,1,0,0,0\n20,32,-14,-5,1,0,0,0\n");
    const auto makeSweep = [&](const std::string& poses, const std::string& more) {
        writeFile(folder_ / "sweep.yml", "poses: {trajectory: {file: t.csv, " + poses +
                                             "}}\nlines: {count: 50, period: 0.1" + more +
                                             "}\npicture: {shape: waterfall}\nclasses: {rock: rock_*}\n");
    };
    makeSweep("period: 5", "");
    const auto files = made("out", {"--format", "npz"});
    EXPECT_EQ(std::ranges::count_if(files, [](const auto& each) { return each.first.ends_with(".npz"); }), 4)
        << "at 0, 5, 10 and 15 s";
    for (const auto& [name, bytes] : files) EXPECT_FALSE(name.starts_with("tracks")) << name;
    const std::string file = std::ranges::find_if(files, [](const auto& each) {
                                 return each.first.starts_with("000002") && each.first.ends_with(".npz");
                             })->first;
    const std::string look = "import numpy; d = numpy.load('" + (folder_ / "out" / file).string() +
                             "'); print(d['bins'].shape, d['object'].shape, d['bearings'].shape, d['positions'][49], "
                             "d['times'][[0, 49]])";
    EXPECT_EQ(insonify::pythonSays("-c \"" + look + "\"", folder_ / "answer"),
              "(50, 2, 400) (50, 2, 400) (2,) [ 24.35 -14.    -5.  ] [10.  14.9]\n")
        << "1.5 m/s along the trajectory";
    const auto refused = [&] {
        const Outcome outcome = callInsonify(folder_, {"dataset", "d.yml", "--sweep", "sweep.yml", "--out", "bad"});
        EXPECT_EQ(outcome.code, 2);
        return outcome.err;
    };
    makeSweep("count: 2, from: 16", "");
    EXPECT_THAT(refused(), HasSubstr("sweep.yml:2:8: lines: take 4.9 s; the trajectory from 16 to 20 s is shorter"));
    makeSweep("count: 2", ", speed: 1");
    EXPECT_THAT(refused(), HasSubstr("sweep.yml:2:8: lines.speed: is given with a trajectory, which has its own"));
    makeSweep("count: 2", ", motion: {heave_m: 1}");
    EXPECT_THAT(refused(), HasSubstr("lines.motion: is given with a trajectory; give it as poses.trajectory.motion"));
}

}  // namespace
