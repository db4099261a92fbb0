#include <gmock/gmock.h>

#include <cmath>

#include "tests/deployer/Wall.hpp"
#include "tests/support/Needs.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::AllOf;
using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

namespace {

json makeScene(const TestFolder& folder, const std::string& file) { return makeJson(folder, {"scene", file}); }

/** A floor of 40 x 30 m at height -2, with a step to -1 in its middle; the file has z up, or y up as in glTF. */
std::string floorGltf(bool z_up) {
    const std::vector<float> up{-20, -15, -2, 20, -15, -2, 20, 15, -2, -20, 15, -2,
                                -1,  -1,  -1, 1,  -1,  -1, 1,  1,  -1, -1,  1,  -1};
    std::vector<float> positions = up;
    for (size_t i = 0; !z_up && i < up.size(); i += 3) {
        positions[i + 1] = up[i + 2];
        positions[i + 2] = -up[i + 1];
    }
    return makeGltf(positions, {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7});
}

}  // namespace

TEST(SceneCommandTest, PrintsBoxTrianglesMaterialsAndObjects) {
    const TestFolder folder;
    const json scene = makeScene(folder, fs::path(insonify::test::source_dir) / "deploy/scenes/wall.glb");
    EXPECT_THAT(scene["bounds"]["min"], ElementsAre(10, -20, -3));
    EXPECT_THAT(scene["bounds"]["max"], ElementsAre(11, 20, 3));
    EXPECT_EQ(scene["objects"].size(), 1u);
    EXPECT_EQ(scene["objects"][0]["name"], "wall");
    EXPECT_EQ(scene["objects"][0]["triangles"], scene["triangles"]);
    const json& material = scene["materials"].at(0);
    EXPECT_EQ(material["name"], "concrete");
    EXPECT_EQ(material["source"], "file");
    EXPECT_NEAR(material["reflection"], 0.66, 0.1);
    EXPECT_NEAR(material["area_m2"], 2 * (40 * 6 + 40 + 6), 1e-3);
    EXPECT_THAT(scene["warnings"], IsEmpty());
    const Outcome words =
        callInsonify(folder, {"scene", fs::path(insonify::test::source_dir) / "deploy/scenes/wall.glb"});
    EXPECT_THAT(words.out, HasSubstr("from [10, -20, -3] to [11, 20, 3] m"));
    EXPECT_THAT(words.out, HasSubstr("concrete"));
    EXPECT_THAT(words.out, HasSubstr(", roughness_slope none, "));
}

TEST(SceneCommandTest, PrintsWallsAndWhatIsBehindThem) {
    const TestFolder folder;
    const fs::path vessels = fs::path(insonify::test::source_dir) / "deploy/scenes/vessels.glb";
    std::map<std::string, json> walls;
    const json scene = makeScene(folder, vessels);
    for (const json& material : scene["materials"]) walls[material["name"]] = material["shell"];
    EXPECT_TRUE(walls.at("sand").is_null());
    EXPECT_EQ(walls.at("glass bottle")["behind"], "water");
    EXPECT_EQ(walls.at("can with air")["behind"], "air");
    EXPECT_NEAR(walls.at("can with air")["thickness_m"], 0.3e-3, 1e-9);
    const std::string words = callInsonify(folder, {"scene", vessels}).out;
    EXPECT_THAT(words, HasSubstr("wall of 0.3 mm, 2700 kg/m3 and 6320 m/s, before air"));
    EXPECT_THAT(words, HasSubstr("before water, passes most sound near multiples of "));
    const json at = makeJson(folder, {"scene", vessels, "--frequency-khz", "900"});
    for (const json& material : at["materials"])
        if (const json& wall = material["shell"]; !wall.is_null()) {
            const double shares = std::pow(10, wall["reflected_db"].get<double>() / 10) +
                                  std::pow(10, wall["passed_db"].get<double>() / 10);
            EXPECT_TRUE(shares > 0.5 && shares < 1.0001) << material["name"] << " " << shares;
        }
    EXPECT_THAT(callInsonify(folder, {"scene", vessels, "--frequency-khz", "900"}).out,
                HasSubstr("before air, at 900 kHz it reflects -0.0 dB and passes "));
    EXPECT_THAT(callInsonify(folder, {"scene", vessels, "--frequency-khz", "0"}),
                isRefused(HasSubstr("--frequency-khz: is 0; must be from 0.001 to 100000")));
    EXPECT_THAT(words, testing::ContainsRegex("  sand  [^\n]*m2; "));
}

TEST(SceneCommandTest, WarnsOfASceneOnItsSideForAFileWithZUpOnly) {
    const TestFolder folder;
    writeFile(folder / "z_up.gltf", floorGltf(true));
    writeFile(folder / "y_up.gltf", floorGltf(false));
    EXPECT_THAT(callInsonify(folder, {"scene", "z_up.gltf"}).out, HasSubstr("may lie on its side"));
    EXPECT_THAT(callInsonify(folder, {"scene", "y_up.gltf"}).out, Not(HasSubstr("on its side")));
    EXPECT_THAT(makeScene(folder, "y_up.gltf")["bounds"]["max"], ElementsAre(20, 15, -1));
}

TEST(SceneCommandTest, WarnsOfAMeshOnItsSideThatWasWrittenWithYUp) {
    const TestFolder folder;
    const std::string faces = "f 1 2 3\nf 1 3 4\n";
    writeFile(folder / "y_up.obj", "v -20 0 -15\nv 20 0 -15\nv 20 0 15\nv -20 0 15\n" + faces);
    writeFile(folder / "z_up.obj", "v -20 -15 0\nv 20 -15 0\nv 20 15 0\nv -20 15 0\n" + faces);
    EXPECT_THAT(callInsonify(folder, {"scene", "y_up.obj"}).out,
                HasSubstr("are taken as z-up; a file written with y up looks like this: export it with Z up, or set "
                          "placement.up: y"));
    EXPECT_THAT(callInsonify(folder, {"scene", "z_up.obj"}).out, Not(HasSubstr("on its side")));
}

TEST(SceneCommandTest, ARunWarnsOfASceneOnItsSideUnlessItIsPlacedUpright) {
    const TestFolder folder;
    writeFile(folder / "z_up.gltf", floorGltf(true));
    const std::string deployment = readFile(fs::path(insonify::test::source_dir) / "deploy/minimal.yml");
    const std::string wall = "scenes/wall.glb";
    ASSERT_THAT(deployment, HasSubstr(wall));
    writeFile(folder / "run.yml", std::string(deployment).replace(deployment.find(wall), wall.size(), "z_up.gltf"));
    const auto warnings = [&](std::vector<std::string> more) {
        std::vector<std::string> words{"run", "run.yml", "--pings", "1", "--out", "out"};
        words.insert(words.end(), more.begin(), more.end());
        return callInsonify(folder, words).err;
    };
    EXPECT_THAT(warnings({}), HasSubstr("warning: scene: the scene may lie on its side: "));
    EXPECT_THAT(warnings({"--set", "scene.placement={up: z}"}), Not(HasSubstr("on its side")));
}

TEST(SceneCommandTest, AMeshWithoutUnitsIsShownAsItsPlacementWouldPlaceIt) {
    const TestFolder folder;
    writeFile(folder / "y_up.obj",
              "v -2000 0 -1500\nv 2000 0 -1500\nv 2000 0 1500\nv -2000 0 1500\nf 1 2 3\nf 1 3 4\n");
    const auto print = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"scene", "y_up.obj"});
        return callInsonify(folder, more);
    };
    EXPECT_THAT(print({}).out, AllOf(HasSubstr("warning: y_up.obj is 4000 x 0 x 3000 m: it states no unit"),
                                     HasSubstr("--scale 0.001"), HasSubstr("may lie on its side")));
    const std::string placed = print({"--up", "y", "--scale", "0.001"}).out;
    EXPECT_THAT(placed, AllOf(HasSubstr("size 4, 3, 0 m"), HasSubstr("scaled by 0.001: "), HasSubstr("its y up")));
    EXPECT_THAT(placed, Not(AnyOf(HasSubstr("states no unit"), HasSubstr("on its side"))));
    EXPECT_THAT(print({"--scale", "1"}).out, Not(HasSubstr("states no unit"))) << "it is answered";
    EXPECT_THAT(print({"--scale", "0"}), isRefused(HasSubstr("--scale: is 0; must be from 1e-06 to 1000000")));
    EXPECT_THAT(print({"--up", "north"}), isRefused(HasSubstr("--up")));
}

/** What a run reports when it starts is reported by a check, which makes no file. */
TEST(SceneCommandTest, ACheckWarnsOfTheSceneAsARunDoes) {
    const TestFolder folder;
    writeFile(folder / "z_up.gltf", floorGltf(true));
    writeFile(folder / "big.obj", "v 0 0 0\nv 2000 0 0\nv 2000 2000 0\nv 0 2000 0\nf 1 2 3\nf 1 3 4\n");
    writeFile(folder / "empty.world",
              "<sdf version='1.9'><world name='w'><include><uri>model://none</uri></include>"
              "</world></sdf>");
    std::string deployment = readFile(fs::path(insonify::test::source_dir) / "deploy/minimal.yml");
    writeFile(folder / "d.yml", replaced(deployment, "scenes/wall.glb", "z_up.gltf"));
    std::map<std::string, std::string> scenes{{"z_up.gltf", "warning: scene: the scene may lie on its side"},
                                              {"big.obj", "notice: scene: big.obj is 2000 x 2000 x 0 m"}};
    if (fs::exists(fs::path(insonify::test::build_dir) / "lib/insonify/sdf.so"))
        scenes["empty.world"] = "the scene has no triangles: an empty sea";
    for (const auto& [scene, text] : scenes) {
        SCOPED_TRACE(scene);
        const std::vector<std::string> set{"--set", "scene.file=" + scene};
        const Outcome run = callInsonify(folder, {"run", "d.yml", "--pings", "1", "--out", "out", set[0], set[1]});
        fs::remove_all(folder / "out");
        const Outcome check = callInsonify(folder, {"check", "d.yml", set[0], set[1]});
        EXPECT_EQ(check.code, 0);
        EXPECT_FALSE(fs::exists(folder / "out"));
        EXPECT_THAT(check.out, HasSubstr(text));
        std::istringstream lines(run.err);
        for (std::string line; std::getline(lines, line);)
            if (line.find(": scene: ") != line.npos) {
                EXPECT_THAT(check.out, HasSubstr(line + "\n"));
            }
        const json reported = json::parse(callInsonify(folder, {"check", "d.yml", "--json", set[0], set[1]}).out);
        EXPECT_THAT(reported["warnings"].dump() + reported["notices"].dump(),
                    HasSubstr(text.substr(text.find("scene"))));
    }
    EXPECT_THAT(
        callInsonify(folder, {"check", "d.yml", "--set", "scene.file=big.obj", "--set", "scene.placement={scale: 1}"})
            .out,
        Not(HasSubstr("states no unit")))
        << "it is answered";
}

TEST(SceneCommandTest, TheDeliveredScenesAreUpright) {
    INSONIFY_NEEDS("sdf");
    const TestFolder folder;
    for (const char* name : {"harbour.glb", "tank.glb", "two_vehicles.world", "wall.glb"})
        for (const json& warning :
             makeScene(folder, fs::path(insonify::test::source_dir) / "deploy/scenes" / name)["warnings"])
            EXPECT_THAT(warning.get<std::string>(), Not(HasSubstr("on its side"))) << name;
}

TEST(SceneCommandTest, ReportsTheDefaultOfAMaterialWithoutAcoustics) {
    const WallFolder folder;
    const json scene = makeScene(folder, "wall.gltf");
    EXPECT_EQ(scene["materials"].at(0)["source"], "default");
    EXPECT_NEAR(scene["materials"].at(0)["lambert_db"], -16.7, 1e-3);
    EXPECT_THAT(scene["warnings"].at(0).get<std::string>(), HasSubstr("sound like medium sand"));
    EXPECT_THAT(callInsonify(folder, {"describe", "wall.gltf"}).out, HasSubstr("medium sand"));
}

TEST(SceneCommandTest, RecognisesMaterialsByNameAndListsThemByObject) {
    const WallFolder folder;
    json gltf = json::parse(readFile(folder / "wall.gltf"));
    gltf["materials"] = json::array({{{"name", "Steel.001"}}});
    gltf["meshes"][0]["primitives"][0]["material"] = 0;
    writeFile(folder / "steel.gltf", gltf.dump());
    const json scene = makeScene(folder, "steel.gltf");
    EXPECT_EQ(scene["materials"].at(0)["source"], "name");
    EXPECT_EQ(scene["materials"].at(0)["matter"], "steel");
    EXPECT_THAT(scene["objects"].at(0)["materials"], ElementsAre("Steel.001"));
    const std::string words = callInsonify(folder, {"scene", "steel.gltf"}).out;
    EXPECT_THAT(words, HasSubstr("; steel at the sonar's frequency, by its name"));
    EXPECT_THAT(words, HasSubstr("are taken by their names: \"Steel.001\" as steel; `materials` of"));
    EXPECT_THAT(scene["warnings"], IsEmpty());
}

TEST(SceneCommandTest, ListsOmittedParts) {
    INSONIFY_NEEDS("sdf");
    const TestFolder folder;
    writeFile(folder / "walls.sdf", R"(<sdf version="1.7"><model name="m"><link name="l"><visual name="v"><geometry>
        <mesh><uri>model://nowhere/wall.dae</uri></mesh></geometry></visual></link></model></sdf>)");
    const json scene = makeScene(folder, "walls.sdf");
    ASSERT_FALSE(scene["not_understood"].empty());
    EXPECT_THAT(scene["not_understood"].at(0).get<std::string>(), HasSubstr("nowhere/wall.dae"));
    EXPECT_TRUE(scene["bounds"].is_null());
    EXPECT_THAT(scene["axes"].get<std::string>(), HasSubstr("z up"));
}

TEST(SceneCommandTest, AFileThatIsNotASceneIsAnErrorThatNamesTheFormats) {
    const TestFolder folder;
    writeFile(folder / "wall.blend", "BLENDER");
    EXPECT_THAT(callInsonify(folder, {"scene", "wall.blend"}),
                isRefused(HasSubstr("may be .gltf, .glb, .world, .sdf, .urdf, .dae, .obj, .stl or .ply")));
    EXPECT_EQ(callInsonify(folder, {"scene", "nowhere.glb"}).code, 2);
}
