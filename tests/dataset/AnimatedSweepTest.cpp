// insonify dataset: samples of a scene with animations.
#include <gmock/gmock.h>

#include <glm/geometric.hpp>
#include <set>

#include "components/scene/motion/Animator.hpp"
#include "tests/dataset/HarbourDeployment.hpp"
#include "tests/deployer/Command.hpp"
#include "tests/scene/AnimatedFiles.hpp"
#include "types/geometry/PosedMesh.hpp"

namespace insonify::dataset {
namespace {

using namespace insonify::deployer;

constexpr double away = 3;  ///< Distance of the sonar from the middle of the eel, to its side [m].
constexpr double bin = 0.02, beam = 60.0 / 256 * 3.14159265 / 180;

const std::string sweep = R"(seed: 3
classes: {eel: skin}
split: {train: 1, val: 0, test: 0}
picture: {height: 300}
annotations: {min_pixels: 1}
)";

struct AnimatedSweepTest : scene::SceneFiles {
    AnimatedSweepTest() {
        write("eel.gltf", gltf(scene::eelText(scene::Tube(30, 24, 0.06f))));
        std::string text = deployment;
        const auto replace = [&](const std::string& old, const std::string& by) {
            text.replace(text.find(old), old.size(), by);
        };
        replace(test::sourceFile("deploy/scenes/harbour.glb"), "eel.gltf");
        replace("mount: {position: [0.4, 0, -0.2], roll_deg: 0, pitch_deg: 12, yaw_deg: 0}", "materials_by_name: true");
        replace("range: 30", "range: 6");
        replace("beam_count: 128", "beam_count: 256");
        replace("bin_count: 200", "bin_count: 300");
        replace("field_of_view_deg: 120", "field_of_view_deg: 60");
        replace("columns_per_beam: 1", "columns_per_beam: 2");
        write("d.yml", text);
    }
    /** Returns the records of a data set, in order. */
    std::vector<json> getRecords(const std::string& poses_and_settings) const {
        write("sweep.yml", sweep + poses_and_settings);
        EXPECT_THAT(callInsonify(owned_, {"dataset", "d.yml", "--sweep", "sweep.yml", "--out", "out"}), succeeds());
        std::map<std::string, json> records;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / "out"))
            if (const std::string name = entry.path().filename(); name.starts_with("0") && name.ends_with(".json"))
                records[name] = json::parse(readFile(entry.path()));
        std::vector<json> all;
        for (auto& [name, record] : records) all.push_back(std::move(record));
        return all;
    }
    /** Expects that a record annotates the eel in its shape at a time [s], up to two bins and beams. */
    void expectShapeAt(double seconds, const json& record) const {
        types::Diagnostics none;
        const auto scene = std::make_shared<const scene::Scene>(scene::readScene((folder_ / "eel.gltf").string()));
        scene::Animator animator(scene, {}, {}, none);
        animator.take(seconds, {});
        types::Snapshot snapshot;
        snapshot.geometry = scene->geometry;
        animator.addMoved(snapshot.moved);
        animator.addDeformed(snapshot);
        const types::GeometryPtr posed = types::posedGeometry(snapshot);
        const types::Mesh& mesh = posed->meshes[static_cast<size_t>(posed->objects[0].mesh)];
        double near = 1e9, low = 1e9, high = -1e9;
        for (const glm::vec3& corner : mesh.positions) {
            const glm::dvec3 p(snapshot.moved[0].world_from_object * glm::dvec4(corner, 1));
            const double x = p.y + away, y = 0.5 - p.x;  // the sonar looks along y, from (0.5, -away)
            near = std::min(near, glm::length(glm::dvec3(x, y, p.z)));
            low = std::min(low, std::atan2(y, x));
            high = std::max(high, std::atan2(y, x));
        }
        ASSERT_EQ(record["annotations"].size(), 1u) << record;
        const json& eel = record["annotations"][0];
        EXPECT_NEAR(eel["range_m"][0].get<double>(), near, 2 * bin) << seconds;
        EXPECT_NEAR(eel["bearing_rad"][0].get<double>(), low, 2 * beam) << seconds;
        EXPECT_NEAR(eel["bearing_rad"][1].get<double>(), high, 2 * beam) << seconds;
    }
};

TEST_F(AnimatedSweepTest, EachSampleShowsTheShapeAtItsOwnTimeOfTheAnimations) {
    const auto records = getRecords(R"(
poses:
  random: {count: 8, x: 0.5, y: -3, z: 0, yaw_deg: 90}
settings:
  scene.animations.*.start_s: {uniform: [0, 2]}
)");
    ASSERT_EQ(records.size(), 8u);
    std::set<std::string> shapes;
    for (const json& record : records) {
        expectShapeAt(record["settings"]["scene.animations.*.start_s"], record);
        shapes.insert(record["annotations"][0]["segmentation"].dump());
    }
    EXPECT_GT(shapes.size(), 5u);
}

TEST_F(AnimatedSweepTest, ATrajectoryShowsTheShapeAtTheTimeOfItsPoses) {
    write("pass.csv",
          "time,x,y,z,qw,qx,qy,qz\n0,0.5,-3,0,0.70710678,0,0,0.70710678\n"
          "1.8,0.5,-3,0,0.70710678,0,0,0.70710678\n");
    const auto records = getRecords(R"(
poses:
  trajectory: {file: pass.csv, count: 5}
settings:
  scene.animations.*.start_s: [0, 0.1]
)");
    ASSERT_EQ(records.size(), 10u);
    std::set<double> times;
    for (const json& record : records) {
        const double start = record["settings"]["scene.animations.*.start_s"], time = record["time_s"];
        expectShapeAt(start + time, record);
        times.insert(time);
    }
    EXPECT_EQ(times.size(), 5u);
}

}  // namespace
}  // namespace insonify::dataset
