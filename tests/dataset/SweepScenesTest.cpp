#include <gmock/gmock.h>

#include <functional>
#include <set>

#include "components/dataset/commands/DatasetRun.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::dataset {
namespace {

using testing::HasSubstr;

/** Two floors of one triangle each, 1 m apart, and a node without any. */
scene::Scene floors() {
    types::Geometry geometry;
    types::Mesh& mesh = geometry.meshes.emplace_back();
    mesh.positions = {{0, 0, -5}, {4, 0, -5}, {0, 4, -5}};
    mesh.indices = {0, 1, 2};
    mesh.clusters = {{.index_count = 3}};
    geometry.materials.push_back({.name = "sand"});
    scene::Scene scene;
    for (const char* name : {"floor_low", "floor_high", "frame"}) {
        scene.nodes.emplace_back().name = name;
        if (scene.nodes.size() == 3) break;
        scene.object_nodes.push_back(static_cast<int>(geometry.objects.size()));
        scene.node_from_object.emplace_back(1);
        geometry.objects.emplace_back().name = name;
    }
    geometry.objects[1].world_from_object[3].z = 1;
    scene.geometry = std::make_shared<const types::Geometry>(std::move(geometry));
    return scene;
}

dataset::Sweep standingOn(const std::string& ground) {
    dataset::Sweep sweep;
    sweep.file = "sweep.yml";
    dataset::ObjectGroup& group = sweep.objects.emplace_back();
    group.names = {"floor_*"};
    group.ground = ground;
    group.line = 4, group.column = 5;
    return sweep;
}

TEST(SweepScenesTest, AGroundIsOfAllNodesThatItsPatternMatches) {
    EXPECT_EQ(getParts(standingOn("floor_low"), floors()).grounds.at("floor_low").size(), 1u);
    const auto both = getParts(standingOn("floor_*"), floors()).grounds.at("floor_*");
    ASSERT_EQ(both.size(), 2u);
    EXPECT_EQ(both[0][0].z, -5);
    EXPECT_EQ(both[1][0].z, -4);
}

TEST(SweepScenesTest, AGroundWithoutASurfaceIsRefusedAtItsPlace) {
    EXPECT_THAT(test::computeError<types::ConfigError>([] { getParts(standingOn("frame"), floors()); }),
                HasSubstr("sweep.yml:4:5: objects[0].ground: is frame, which has no surface to stand on"));
}

TEST(SweepScenesTest, AnObjectHasItsNodesNamesUpToTheRoot) {
    scene::Scene scene = floors();
    scene.nodes.push_back({.name = "sea"});
    scene.nodes[2].parent = 3;
    scene.nodes[0].parent = 2;
    EXPECT_EQ(lineages(scene), (std::vector<Lineage>{{"floor_low", "frame", "sea"}, {"floor_high"}}));
}

using Changes = std::vector<std::function<void(types::Geometry&)>>;

/** Floors with a normal map and a surface map. */
types::Geometry mappedFloors() {
    const types::SurfaceMap map{
        .width = 2, .height = 1, .strengths = {1, 0.5f}, .classes = {0, types::SurfaceMap::no_class}, .materials = {1}};
    types::Geometry geometry = *floors().geometry;
    geometry.meshes[0].normals.assign(3, {0, 0, 1});
    geometry.meshes[0].tangents.assign(3, {1, 0, 0, 1});
    geometry.meshes[0].map_uvs.assign(3, {0, 1});
    geometry.meshes[0].maps.push_back({0, std::make_shared<const types::SurfaceMap>(map)});
    geometry.normal_maps.push_back({.width = 2, .height = 1, .rgb = {0, 0, 255, 0, 0, 255}});
    return geometry;
}

/** Expects that each change gives a different digest. */
void expectOthers(const types::Geometry& plain, const Changes& changes) {
    std::set<std::string> digests = {computeDigest(plain)};
    for (size_t i = 0; i < changes.size(); ++i) {
        types::Geometry changed = plain;
        changes[i](changed);
        EXPECT_TRUE(digests.insert(computeDigest(changed)).second) << i;
    }
}

TEST(SweepScenesTest, EveryAcousticPropertyOfAGeometryChangesItsDigest) {
    const types::Geometry plain = mappedFloors();
    const Changes changes = {
        [](auto& changed) { changed.meshes[0].positions[1].x = 5; },
        [](auto& changed) { changed.meshes[0].tangents[0].w = -1; },
        [](auto& changed) { changed.meshes[0].clusters[0].material = 1; },
        [](auto& changed) { changed.meshes[0].clusters[0].first_index = 3; },
        [](auto& changed) { changed.meshes[0].clusters[0].index_count = 0; },
        [](auto& changed) { changed.objects[1].world_from_object[3].z = 2; },
        [](auto& changed) { changed.materials[0].has_acoustics = true; },
        [](auto& changed) {
            changed.materials[0].measured = {{10, -30}};
        },
        [](auto& changed) { changed.materials[0].shell = types::Shell{}; },
        [](auto& changed) { changed.materials[0].shell = {.thickness = 0.01}; },
        [](auto& changed) { changed.materials[0].shell = {.density = 1000}; },
        [](auto& changed) { changed.materials[0].shell = {.sound_speed = 2000}; },
        [](auto& changed) { changed.materials[0].shell = {.shear_speed = 900}; },
        [](auto& changed) { changed.materials[0].shell = {.loss = 0.1}; },
        [](auto& changed) { changed.materials[0].shell = {.has_air = true}; },
        [](auto& changed) { changed.materials[0].shell = {.fill_density = 900}; },
        [](auto& changed) { changed.materials[0].shell = {.fill_speed = 1400}; },
        [](auto& changed) { changed.materials[0].shell = {.fill_loss = 0.1}; },
        [](auto& changed) { changed.materials[0].normal_map = 0; },
        [](auto& changed) { changed.materials[0].normal_scale = 2; },
        [](auto& changed) { std::swap(changed.normal_maps[0].width, changed.normal_maps[0].height); },
        [](auto& changed) { changed.normal_maps[0].repeat_u = false; },
        [](auto& changed) { changed.normal_maps[0].repeat_v = false; },
        [](auto& changed) { changed.normal_maps[0].rgb[0] = 9; },
    };
    expectOthers(plain, changes);
    EXPECT_EQ(computeDigest(plain), computeDigest(types::Geometry(plain)));
}

TEST(SweepScenesTest, EveryAcousticPropertyOfASurfaceMapChangesTheDigest) {
    const auto remapped = [](const auto& change) {
        return [change](types::Geometry& changed) {
            types::SurfaceMap other = *changed.meshes[0].maps[0].map;
            change(other);
            changed.meshes[0].maps[0].map = std::make_shared<const types::SurfaceMap>(other);
        };
    };
    expectOthers(mappedFloors(), {
                                     [](auto& changed) { changed.meshes[0].map_uvs[0].x = 0.5f; },
                                     [](auto& changed) { changed.meshes[0].maps[0].material = 1; },
                                     [](auto& changed) { changed.meshes[0].maps.clear(); },
                                     remapped([](auto& other) { std::swap(other.width, other.height); }),
                                     remapped([](auto& other) { other.strengths[1] = 0.25f; }),
                                     remapped([](auto& other) { other.classes[1] = 0; }),
                                     remapped([](auto& other) { other.materials[0] = 0; }),
                                     remapped([](auto& other) { other.repeat_u = false; }),
                                     remapped([](auto& other) { other.repeat_v = false; }),
                                 });
}

}  // namespace
}  // namespace insonify::dataset
