// insonify dataset: a shadow is what an object hides.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "components/deployer/Simulation.hpp"
#include "tests/deployer/Command.hpp"
#include "tests/scene/SceneFiles.hpp"
#include "tests/support/Draw.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::dataset {
namespace {

using deployer::json;

/** A box in the world, turned about z. */
struct Block {
    std::string name;
    glm::dvec3 centre, size;  ///< [m]
    double yaw = 0;           ///< [rad]
};

/** Returns a glTF file of boxes. */
std::string writeBlocks(const std::vector<Block>& boxes) {
    std::string corners, nodes, list;
    for (const float x : {-0.5f, 0.5f})
        for (const float y : {-0.5f, 0.5f})
            for (const float z : {-0.5f, 0.5f}) corners += scene::toBytes<float>({x, y, z});
    const std::string triangles = scene::toBytes<uint16_t>(
        {0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3});
    for (const Block& box : boxes) {
        list += fmt::format("{}{}", list.empty() ? "" : ",", nodes.empty() ? 0 : std::ranges::count(nodes, '\n'));
        nodes += fmt::format(
            "{}\n{{\"name\":\"{}\",\"mesh\":0,\"translation\":[{},{},{}],\"scale\":[{},{},{}],\"rotation\":[0,{},0,{}]}"
            "}",
            nodes.empty() ? "" : ",", box.name, box.centre.x, box.centre.z, -box.centre.y, box.size.x, box.size.z,
            box.size.y, std::sin(box.yaw / 2), std::cos(box.yaw / 2));
    }
    return fmt::format(
        R"("scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":8}},{{"bufferView":1,"componentType":5123,"type":"SCALAR","count":36}}],
"bufferViews":[{{"buffer":0,"byteLength":96}},{{"buffer":0,"byteOffset":96,"byteLength":72}}],{})",
        list, nodes, scene::buffers(corners + triangles));
}

/** A sonar 0.6 m above the floor that looks ahead and down. */
struct LowSonar {
    double pitch_deg = 14.1, height_deg = 14, range = 4;
    int beams = 48, bins = 400;
};

std::string writeDeployment(const LowSonar& sonar) {
    return fmt::format(R"(schedule: lockstep
tasks:
  vehicle: {{type: pose::TrajectoryTask, activity: {{period: 0.1}}, properties: {{waypoints: [{{time: 0, position: [0, 0, 0]}}]}}}}
  scene: {{type: scene::SceneTask, properties: {{file: scene.gltf, mount: {{pitch_deg: {}}}}}}}
  sonar: {{type: sonar::SonarTask, properties: {{range: {}, range_min: 0.3, range_rounding: exact, beam_count: {}, bin_count: {},
    field_of_view_deg: 30, beam_height_deg: {}, quality: {{rows: 256, columns_per_beam: 2}}}}}}
connections:
  - {{from: vehicle.pose, to: scene.pose}}
  - {{from: scene.snapshot, to: sonar.snapshot}}
)",
                       sonar.pitch_deg, sonar.range, sonar.beams, sonar.bins, sonar.height_deg);
}

const std::string shadow_sweep = R"(poses: {grid: {z: 0.6}}
classes: {thing: thing_*}
picture: {shape: polar, height: 400}
annotations: {shadows: true, min_pixels: 1, min_share: 0}
)";

struct ShadowTest : scene::SceneFiles {
    /** Returns the annotations of the only sample of these boxes on the floor, with its record. */
    json annotate(const std::vector<Block>& boxes, const LowSonar& sonar) const {
        write("scene.gltf", gltf(writeBlocks(boxes)));
        write("d.yml", writeDeployment(sonar));
        write("sweep.yml", shadow_sweep);
        std::filesystem::remove_all(folder_ / "out");
        EXPECT_THAT(deployer::callInsonify(owned_, {"dataset", "d.yml", "--sweep", "sweep.yml", "--out", "out"}),
                    deployer::succeeds());
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / "out"))
            if (const std::string name = entry.path().filename(); name.starts_with("0") && name.ends_with(".json"))
                return json::parse(deployer::readFile(entry.path()));
        return {};
    }
    /** Returns the truth of the same ping without one object of the scene. */
    types::SonarTruthPtr render(const std::string& omitted) const {
        deployer::SimulationOptions options;
        options.truth = true;
        if (!omitted.empty()) options.overrides.push_back("scene.omit=[" + omitted + "]");
        deployer::Simulation simulation(folder_ / "d.yml", options);
        types::Pose pose;
        pose.position.z = 0.6;
        return simulation.step({{simulation.poses().front(), pose}}, {}).front().truth;
    }
};

Block makeFloor() { return {"floor", {5, 0, -0.05}, {12, 12, 0.1}}; }

/** Floor is in the aperture from 1.663 m on. A can at 1.44 to 1.54 m reaches into it and hides floor up to 1.885 m. */
TEST_F(ShadowTest, FloorBelowTheApertureIsNoShadow) {
    const Block can{"thing_can", {1.395, 0, 0.06}, {0.07, 0.07, 0.12}};
    const json record = annotate({makeFloor(), can}, {});
    ASSERT_EQ(record["annotations"].size(), 2u);
    const json& shadow = record["annotations"][1];
    ASSERT_TRUE(shadow["shadow"].get<bool>());
    EXPECT_LT(record["annotations"][0]["range_m"][1].get<double>(), 1.57);
    EXPECT_NEAR(shadow["range_m"][0].get<double>(), 0.6 / std::sin(types::radians(21.1)), 0.02);
    EXPECT_NEAR(shadow["range_m"][1].get<double>(), 0.6 / std::sin(std::atan(0.48 / 1.43)), 0.02);
}

/** What hides nothing has no shadow: nothing is behind or below a box beyond the end of the floor. */
TEST_F(ShadowTest, OpenWaterBehindAnObjectIsNoShadow) {
    const Block floor{"floor", {0.9, 0, -0.05}, {2, 6, 0.1}};
    const json record = annotate({floor, {"thing_1", {2.05, 0, 0.15}, {0.1, 0.3, 0.3}}}, {});
    ASSERT_EQ(record["annotations"].size(), 1u);
    EXPECT_FALSE(record["annotations"][0]["shadow"].get<bool>());
}

/** Returns for each bin the number of the annotation of a shadow, from 1, by the masks of a polar picture, whose
 *  columns are beams from port and whose lowest row is the nearest bin. */
std::vector<size_t> readShadows(const json& record, const types::SonarTruth& truth) {
    const size_t bins = truth.bin_count, beams = truth.beam_count;
    std::vector<size_t> shadow_of(bins * beams, 0);
    for (size_t number = 0; number < record["annotations"].size(); ++number) {
        const json& each = record["annotations"][number];
        if (!each["shadow"].get<bool>()) continue;
        size_t pixel = 0;
        bool is_inside = false;
        for (const json& run : each["segmentation"]["counts"]) {
            for (size_t end = pixel + run.get<size_t>(); pixel < end; ++pixel)
                if (is_inside) shadow_of[(beams - 1 - pixel / bins) * bins + bins - 1 - pixel % bins] = number + 1;
            is_inside = !is_inside;
        }
    }
    return shadow_of;
}

/** In random scenes each annotated shadow is what is dark with the object and lit in a scene without it. */
TEST_F(ShadowTest, ShadowsAreWhatIsLitWithoutTheObject) {
    const test::Seeds seeds(6);
    size_t found = 0, wrong = 0, missed = 0;
    for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
        test::Draw draw(seed);
        const LowSonar sonar{draw.between(8, 25), draw.between(10, 30), draw.between(3, 5)};
        std::vector<Block> boxes{makeFloor()};
        if (draw.once(2)) boxes.push_back({"wall", {draw.between(2.5, 5), 0, 0.5}, {0.2, 6, 1}});
        const int count = 1 + draw.upTo(4);
        for (int i = 0; i < count; ++i) {
            const glm::dvec3 size{draw.between(0.05, 0.4), draw.between(0.05, 0.4), draw.between(0.05, 0.5)};
            const double lift = draw.once(3) ? draw.between(0, 0.3) : 0;
            boxes.push_back({fmt::format("thing_{}", i),
                             {draw.between(0.9, 3), draw.between(-0.6, 0.6), lift + size.z / 2},
                             size,
                             draw.between(0, 3)});
        }
        const json record = annotate(boxes, sonar);
        const types::SonarTruthPtr with = render("");
        ASSERT_EQ(record["picture"]["width"], with->beam_count);
        ASSERT_EQ(record["picture"]["height"], with->bin_count);
        const std::vector<size_t> shadow_of = readShadows(record, *with);
        std::map<std::string, types::SonarTruthPtr> without;
        for (const json& each : record["annotations"])
            if (!each["shadow"].get<bool>()) without[each["name"]] = render(each["name"]);
        for (size_t bin = 0; bin < shadow_of.size(); ++bin) {
            bool is_hidden = false;
            for (const auto& [name, truth] : without)
                is_hidden = is_hidden || (with->hits[bin] == 0 && truth->hits[bin] > 0);
            const std::string name =
                shadow_of[bin] > 0 ? record["annotations"][shadow_of[bin] - 1]["name"].get<std::string>() : "";
            const bool is_right = !name.empty() && with->hits[bin] == 0 && without.at(name)->hits[bin] > 0;
            found += is_right, wrong += !name.empty() && !is_right, missed += name.empty() && is_hidden;
        }
    }
    std::cout << found << " bins of shadows, " << wrong << " wrong, " << missed << " missed\n";
    EXPECT_GT(found, 500 * seeds.count);
    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(missed, 0u);
}

}  // namespace
}  // namespace insonify::dataset
