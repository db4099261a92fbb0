// Drawn water, invisible visuals and names that the configuration omits are omitted.
#include <gmock/gmock.h>

#include <random>

#include "components/scene/Drawings.hpp"
#include "tests/scene/SceneTaskFiles.hpp"

namespace insonify::scene {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

/** A box of one material. */
types::Mesh boxMesh(glm::vec3 half, int material) {
    types::Mesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.positions.push_back(
            {(corner & 1) ? half.x : -half.x, (corner & 2) ? half.y : -half.y, (corner & 4) ? half.z : -half.z});
    mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                    2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    mesh.clusters = {{.first_index = 0, .index_count = 36, .material = material}};
    return mesh;
}

/** A scene of boxes, each a visual of its own model. */
struct Boxes {
    Scene scene;
    types::Geometry geometry;

    void add(const std::string& model, const std::string& visual, glm::vec3 size, glm::dvec3 at, Drawing drawing = {},
             const std::string& material = "default", bool has_acoustics = false) {
        types::Material made;
        made.name = material;
        made.has_acoustics = has_acoustics;
        geometry.materials.push_back(made);
        geometry.meshes.push_back(boxMesh(size / 2.0f, static_cast<int>(geometry.materials.size()) - 1));
        glm::dmat4 place(1);
        place[3] = glm::dvec4(at, 1);
        const auto node = static_cast<int>(scene.nodes.size());
        scene.nodes.push_back({model, -1, place, glm::dvec3(1)});
        scene.nodes.push_back({model + "::link", node, glm::dmat4(1), glm::dvec3(1)});
        geometry.objects.push_back({model + "::link::" + visual, static_cast<int>(geometry.meshes.size()) - 1, place});
        scene.object_nodes.push_back(node + 1);
        scene.node_from_object.push_back(glm::dmat4(1));
        scene.drawings.push_back(drawing);
    }
    Scene kept(const OmitRules& rules) {
        scene.geometry = std::make_shared<const types::Geometry>(geometry);
        return withoutOmitted(scene, rules);
    }
    std::vector<std::string> namesKept(const OmitRules& rules) {
        std::vector<std::string> names;
        const Scene scene_kept = kept(rules);
        for (const types::Object& object : scene_kept.geometry->objects) names.push_back(object.name);
        return names;
    }
};

const OmitRules at_zero{{}, true, 0.0, {}};

TEST(DrawingsTest, PatternsMatchAnyTextForEachStar) {
    for (const char* name : {"water", "sea water", "water_2", "waterwater"})
        EXPECT_TRUE(matches("*water*", name)) << name;
    for (const auto& [pattern, name] : {std::pair("water", "water_2"), {"w*r", "water_"}, {"", "a"}, {"a*b*c", "acb"}})
        EXPECT_FALSE(matches(pattern, name)) << pattern << " " << name;
    EXPECT_TRUE(matches("a*b*c", "aXbYbZc") && matches("**", "") && matches("", "") && matches("[x].+", "[x].+"));
    std::mt19937 random(1);  // a pattern made of a name by replacing parts with * matches it
    for (int run = 0; run < 1000; ++run) {
        std::string name, pattern;
        for (int i = 0; i < 12; ++i) {
            const char letter = static_cast<char>('a' + random() % 2);
            name += letter;
            pattern += random() % 3 == 0 ? '*' : letter;
        }
        EXPECT_TRUE(matches(pattern, name)) << pattern << " " << name;
        if (pattern.find('*') == std::string::npos) {
            EXPECT_FALSE(matches(pattern, name + "b"));
        }
    }
}

TEST(DrawingsTest, NamesOmitModelsLinksAndVisualsWithAllBelow) {
    Boxes boxes;
    for (const char* model : {"rov", "rov_helper", "pier"}) boxes.add(model, "hull", {1, 1, 1}, {0, 0, -5});
    const auto kept = [&](std::vector<std::string> names) { return boxes.namesKept({std::move(names), true, {}, {}}); };
    EXPECT_THAT(kept({"rov"}), ElementsAre("rov_helper::link::hull", "pier::link::hull"));
    EXPECT_THAT(kept({"rov*"}), ElementsAre("pier::link::hull"));
    EXPECT_THAT(kept({"rov::link", "pier::link::hull"}), ElementsAre("rov_helper::link::hull"));
    EXPECT_THAT(kept({"*::hull"}), IsEmpty());
    EXPECT_THAT(kept({"hull"}), IsEmpty()) << "a name without :: is that of any visual, link or model";
    const Scene scene = boxes.kept({{"rov", "rof", "*pire*"}, true, {}, {}});
    EXPECT_EQ(scene.nodes.size(), 6u) << "nodes stay: they have ports";
    ASSERT_EQ(scene.omitted.size(), 1u);
    EXPECT_EQ(scene.omitted[0].name, "rov::link::hull");
    EXPECT_EQ(scene.omitted[0].reason, "omit: \"rov\"");
    EXPECT_THAT(scene.warnings,
                ElementsAre(testing::AllOf(HasSubstr("\"rof\" matches no"), HasSubstr("did you mean rov")),
                            HasSubstr("\"*pire*\" matches no")));
}

TEST(DrawingsTest, AnInvisibleDrawingIsOmittedUnlessItHasAcoustics) {
    Boxes boxes;
    boxes.add("ghost", "v", {1, 4, 1}, {8, 0, -3}, {.transparency = 1});
    boxes.add("for_none", "v", {1, 4, 1}, {8, 0, -3}, {.is_for_none = true});
    boxes.add("window", "v", {1, 4, 1}, {8, 0, -3}, {.transparency = 0.9});
    boxes.add("steel_ghost", "v", {1, 4, 1}, {8, 0, -3}, {.transparency = 1}, "steel");
    boxes.add("acoustic", "v", {1, 4, 1}, {8, 0, -3}, {.transparency = 1}, "own", true);
    boxes.add("given", "v", {1, 4, 1}, {8, 0, -3}, {.transparency = 1}, "paint");
    EXPECT_THAT(boxes.namesKept({{}, true, {}, {"given"}}),
                ElementsAre("window::link::v", "acoustic::link::v", "given::link::v"));
    EXPECT_THAT(boxes.namesKept({{}, true, {}, {"paint"}}), Contains("given::link::v"));
    EXPECT_EQ(boxes.namesKept({{}, false, {}, {}}).size(), 6u);
}

TEST(DrawingsTest, DrawnWaterIsOmittedAndBodiesAtTheSurfaceAreNot) {
    struct Case {
        const char *model, *visual, *material;
        glm::vec3 size;
        double z;
        Drawing drawing;
        bool without_surface, at_surface;  ///< Whether it is kept.
    };
    const Drawing plain, clear{.transparency = 0.6}, shadowless{.casts_shadow = false}, some{.is_for_some = true};
    const std::vector<Case> cases{
        {"ocean", "water_surface", "default", {200, 200, 0.01f}, 0, {0.6, false, true, false}, false, false},
        {"sea_surface", "visual", "default", {200, 200, 0}, 0, plain, false, false},
        {"world", "v", "Water", {200, 200, 2}, -0.5, plain, false, false},
        {"tank", "v", "default", {4, 4, 0.01f}, 0, {0.6, false, false, false}, false, false},
        {"unnamed", "v", "default", {200, 200, 0.01f}, 0, plain, true, false},
        {"unnamed", "v", "default", {200, 200, 0.01f}, 0, clear, true, false},
        {"unnamed", "v", "default", {200, 200, 0.01f}, 0, shadowless, true, false},
        {"unnamed", "v", "default", {200, 200, 0.01f}, 0, some, true, false},
        {"unnamed", "v", "default", {200, 200, 0.01f}, -5, clear, true, true},  // a glass plate in the water
        {"sea", "floor", "default", {200, 200, 0.1f}, -20, plain, true, true},
        {"water_tank", "floor", "default", {200, 200, 0.1f}, -20, plain, true, true},
        {"ocean", "floor", "default", {200, 200, 0.1f}, -20, plain, true, true},
        {"ocean", "surface", "default", {200, 200, 1}, 0, plain, false, false},
        {"ocean", "visual", "default", {20, 20, 0.3f}, 0, plain, true, false},
        {"Plane", "Ocean.001", "default", {20, 20, 0.3f}, 0, plain, true, false},
        {"Plane", "ocean_wreck", "default", {20, 20, 0.3f}, 0, plain, true, true},
        {"seat", "visual", "default", {20, 20, 0.3f}, 0, plain, true, true},
        {"raft", "v", "default", {12, 12, 0.2f}, 0, plain, true, true},
        {"ice", "v", "default", {200, 200, 1}, -0.5, plain, true, true},
        {"pontoon", "v", "steel", {200, 200, 0.01f}, 0, clear, true, true},
        {"waterjet", "hull", "default", {2, 1, 1}, 0, plain, true, true},
        {"water_volume", "v", "default", {200, 200, 20}, -10, clear, false, false},
        {"buoy", "glass", "default", {1, 1, 1}, 0, clear, true, true}};
    for (const Case& one : cases) {
        SCOPED_TRACE(testing::Message() << one.model << " " << one.visual << " at " << one.z << " " << one.size.z);
        for (const bool at_surface : {false, true}) {
            Boxes boxes;
            boxes.add("ground", "rocks", {210, 210, 3}, {0, 0, -25});
            boxes.add(one.model, one.visual, one.size, {0, 0, one.z}, one.drawing, one.material);
            const size_t expected = (at_surface ? one.at_surface : one.without_surface) ? 2 : 1;
            EXPECT_EQ(boxes.namesKept(at_surface ? at_zero : OmitRules{}).size(), expected) << at_surface;
        }
    }
}

TEST(DrawingsTest, ALargeLevelBodyAtTheSurfaceIsAWarningWithTheWayOut) {
    Boxes boxes;
    boxes.add("ground", "rocks", {210, 210, 3}, {0, 0, -25});
    boxes.add("lid", "v", {20, 30, 0.2f}, {0, 0, 0});
    for (const OmitRules& rules : {at_zero, OmitRules{}})
        EXPECT_THAT(boxes.kept(rules).warnings, ElementsAre(HasSubstr("omit: [lid::link::v]")));
    EXPECT_THAT(boxes.kept({{"lid"}, true, 0.0, {}}).warnings, IsEmpty());
    EXPECT_THAT(boxes.kept({{}, true, 0.0, {"lid"}}).warnings, IsEmpty()) << "it has a material";
    EXPECT_THAT(boxes.kept({{}, false, 0.0, {}}).warnings, IsEmpty());
    EXPECT_THAT(boxes.kept({{}, true, -10.0, {}}).warnings, IsEmpty());
}

TEST(DrawingsTest, NoticesListOmissionsByReason) {
    Boxes boxes;
    for (int i = 0; i < 7; ++i) boxes.add("ghost" + std::to_string(i), "v", {1, 1, 1}, {0, 0, -3}, {.transparency = 1});
    types::Notices notices;
    addOmissions(boxes.kept({{"x"}, true, {}, {}}), notices);
    EXPECT_THAT(types::lines(notices),
                ElementsAre(testing::AllOf(testing::StartsWith("omitted: ghost0::link::v, "),
                                           HasSubstr(" and 2 more: its drawing is wholly transparent")),
                            testing::StartsWith("Warning: omit: \"x\"")));
}

struct GltfDrawingsTest : SceneFiles {
    /** A file of two triangles, of materials "seen" and "hidden". */
    Scene two(const std::string& hidden) const {
        return readScene(
            write("two.gltf", gltf(R"("scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"name":"a"},{"mesh":1,"name":"b"}],
            "materials":[{"name":"seen"},{"name":"hidden",)" +
                                   hidden + R"(}],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]},
                      {"primitives":[{"attributes":{"POSITION":0},"material":1},{"attributes":{"POSITION":0},"material":0}]}],)" +
                                   triangle(toBytes<float>({0, 0, 0, 1, 0, 0, 0, 2, 3})))));
    }
};

TEST_F(GltfDrawingsTest, AMaterialOfAlphaZeroIsOmitted) {
    const std::string clear = R"("pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0]})";
    for (const char* mode : {R"(,"alphaMode":"BLEND")", R"(,"alphaMode":"MASK")"}) {
        const Scene scene = two(clear + mode);
        EXPECT_EQ(scene.geometry->triangleCount(), 2u) << mode;
        ASSERT_EQ(scene.omitted.size(), 1u);
        EXPECT_EQ(scene.omitted[0].name, "hidden");
    }
    EXPECT_EQ(two(clear).geometry->triangleCount(), 3u) << "opaque materials ignore alpha";
    EXPECT_EQ(
        two(R"("alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.1]})").geometry->triangleCount(),
        3u)
        << "glass is solid";
    EXPECT_EQ(
        two(clear + R"(,"alphaMode":"BLEND","extras":{"acoustics":{"material":"steel"}})").geometry->triangleCount(),
        3u);
}

TEST_F(GltfDrawingsTest, TheOpacityOfAnObjectIsThatOfItsMostOpaqueMaterial) {
    const Scene scene = two(R"("alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.25]})");
    ASSERT_EQ(scene.drawings.size(), 2u);
    EXPECT_EQ(scene.drawings[0].transparency, 0);
    EXPECT_EQ(scene.drawings[1].transparency, 0);
    const Scene water = readScene(write("w.gltf", gltf(R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"name":"Plane"}],
        "materials":[{"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.25]}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],)" +
                                                       triangle(toBytes<float>({0, 0, 0, 90, 0, 0, 0, 0, 90})))));
    EXPECT_EQ(water.drawings.at(0).transparency, 0.75);
    EXPECT_EQ(withoutOmitted(water, at_zero).geometry->objects.size(), 0u);
    EXPECT_EQ(withoutOmitted(water, {}).geometry->objects.size(), 1u);
}

/** A file of two nodes with a triangle each, "hull" and "wall". */
const std::string hull_and_wall =
    R"("scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"name":"hull"},{"mesh":0,"name":"wall"}],
       "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)" +
    triangle(toBytes<float>({0, 0, 0, 1, 0, 0, 0, 2, 3}));

struct OmitTaskTest : SceneTaskFiles {
    OmitTaskTest() : SceneTaskFiles(hull_and_wall) {}
};

TEST_F(OmitTaskTest, TheSnapshotLacksWhatIsOmitted) {
    config_.omit = {"hu*", "wal"};
    start();
    const types::SnapshotPtr snapshot = ping(at(1, {0, 0, 0}));
    ASSERT_TRUE(snapshot);
    ASSERT_EQ(snapshot->geometry->objects.size(), 1u);
    EXPECT_EQ(snapshot->geometry->objects[0].name, "wall");
    EXPECT_THAT(task_.notices(), Contains(HasSubstr("omitted: hull: omit: \"hu*\"")));
    EXPECT_THAT(types::lines(task_.notices()), Contains(testing::AllOf(testing::StartsWith("Warning: omit: \"wal\""),
                                                                       HasSubstr("did you mean wall"))));
    ASSERT_TRUE(task_.stop() && task_.cleanup());
    config_.omit = {};
    start();
    EXPECT_EQ(ping(at(2, {0, 0, 0}))->geometry->objects.size(), 2u) << "the scene is taken anew";
}

}  // namespace
}  // namespace insonify::scene
