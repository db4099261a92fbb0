// Models from other sources, valid and invalid, in the shared folder.
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "components/scene/motion/Animator.hpp"
#include "tests/scene/SceneFiles.hpp"
#include "tests/support/Paths.hpp"
#include "types/geometry/PosedMesh.hpp"

namespace insonify::scene {
namespace {

struct CorpusTest : ::testing::Test {
    void SetUp() override {
        if (!std::filesystem::is_directory(models_))
            GTEST_SKIP() << "NO MODELS AT " << models_ << ": NOTHING WAS TESTED";
    }
    types::GeometryPtr load(const std::string& file) const { return loadScene(models_ / file); }
    /** Checks that every glTF file below a folder ends in a sound scene or a ConfigError; returns the number of
     *  scenes. */
    size_t loadAll(const std::string& folder, size_t at_least) const {
        size_t files = 0, scenes = 0;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(models_ / folder)) {
            const auto extension = entry.path().extension();
            if (extension != ".gltf" && extension != ".glb") continue;
            ++files;
            SCOPED_TRACE(entry.path());
            try {
                expectSound(*loadScene(entry.path()));
                ++scenes;
            } catch (const types::ConfigError& error) {
                EXPECT_EQ(std::string(error.what()).find(entry.path().string()), 0u) << error.what();
            }
        }
        EXPECT_GE(files, at_least);
        return scenes;
    }

    std::filesystem::path models_ = std::filesystem::path(test::shared_data) / "gltf";
};

TEST_F(CorpusTest, EveryValidModelIsLoaded) { EXPECT_EQ(loadAll("valid", 11), 11u); }

TEST_F(CorpusTest, EveryConformanceCaseIsLoaded) { EXPECT_EQ(loadAll("asset-generator", 43), 43u); }

TEST_F(CorpusTest, OnlyDracoIsRefusedAmongTheEncodings) { EXPECT_EQ(loadAll("ext", 10), 9u); }

TEST_F(CorpusTest, EveryValidatorCaseIsASceneOrAnError) { EXPECT_GT(loadAll("validator", 150), 50u); }

TEST_F(CorpusTest, EveryInvalidFileIsASceneOrAnError) { loadAll("invalid", 20); }

TEST_F(CorpusTest, KnownModelsHaveTheirTrianglesAndSize) {
    const std::map<std::string, std::pair<size_t, Bounds>> known = {
        {"valid/Box/Box.glb", {12, {glm::dvec3(-0.5), glm::dvec3(0.5)}}},
        {"valid/BoxInterleaved/BoxInterleaved.glb", {12, {glm::dvec3(-0.5), glm::dvec3(0.5)}}},
        {"valid/SimpleSparseAccessor/SimpleSparseAccessor.gltf", {12, {{0, 0, 0}, {6, 0, 4}}}},
        {"valid/TriangleWithoutIndices/TriangleWithoutIndices.gltf", {1, {{0, 0, 0}, {1, 0, 1}}}},
        {"ext/TriangleWithPaddingInGlbBin.glb", {1, {{0, 0, 0}, {1, 0, 1}}}},
        {"ext/webp_BoxTextured/BoxTexturedWebp.gltf", {12, {glm::dvec3(-0.5), glm::dvec3(0.5)}}},
    };
    for (const auto& [file, expected] : known) {
        const auto geometry = load(file);
        const Bounds bounds = getBounds(*geometry);
        EXPECT_EQ(geometry->triangleCount(), expected.first) << file;
        EXPECT_LT(glm::distance(bounds.low, expected.second.low) + glm::distance(bounds.high, expected.second.high),
                  1e-6)
            << file;
    }
}

TEST_F(CorpusTest, OneCubeInFiveEncodingsHasTheSameSurface) {
    for (const char* name : {"cube", "cubeIndexed", "cubeStrip", "cubeFan", "cubeQuantized"}) {
        const auto geometry = load("ext/" + std::string(name) + ".glb");
        const auto corners = worldCorners(*geometry);
        double area = 0, volume = 0;
        for (size_t i = 0; i < corners.size(); i += 3) {
            area += glm::length(glm::cross(corners[i + 1] - corners[i], corners[i + 2] - corners[i])) / 2;
            volume +=
                glm::dot(corners[i], glm::cross(corners[i + 1], corners[i + 2])) / 6;  // positive: faces look outward
        }
        EXPECT_NEAR(area, 6, 1e-6) << name;
        EXPECT_NEAR(volume, 1, 1e-6) << name;
    }
}

TEST_F(CorpusTest, TheArrowsOfTheOrientationTestPointAtTheirTargets) {
    // An arrow is on a face of a cube, turned by its node; its target is modelled on the face without any transform.
    const auto geometry = load("valid/OrientationTest/OrientationTest.glb");
    const auto wayFromAxis = [&](const std::string& name, int axis) {
        const auto object = std::ranges::find(geometry->objects, name, &types::Object::name);
        EXPECT_NE(object, geometry->objects.end()) << name;
        const Bounds bounds = getBounds(*geometry, *object);
        glm::dvec3 centre = (bounds.low + bounds.high) / 2.0;
        centre[axis] = 0;
        return glm::normalize(centre);
    };
    const std::map<std::string, int> axes = {{"X", 0}, {"Y", 2}, {"Z", 1}};  // y of the file is z of the world
    for (const auto& [letter, axis] : axes)
        for (const char* number : {"1", "2"})
            EXPECT_GT(
                glm::dot(wayFromAxis("Arrow" + letter + number, axis), wayFromAxis("Target" + letter + number, axis)),
                0.98)  // centres of boxes are 10 degrees off
                << letter << number;
}

TEST_F(CorpusTest, MirroredNodesReflectTheSameMesh) {
    const auto plain = load("asset-generator/Node_NegativeScale/Node_NegativeScale_00.gltf");
    const auto by_matrix = load("asset-generator/Node_NegativeScale/Node_NegativeScale_03.gltf");
    const auto by_scale = load("asset-generator/Node_NegativeScale/Node_NegativeScale_12.gltf");
    const glm::dmat4 reflected = plain->objects.at(1).world_from_object * glm::scale(glm::dmat4(1), glm::dvec3(-1));
    EXPECT_EQ(by_matrix->objects.at(1).world_from_object, reflected);
    EXPECT_EQ(by_scale->objects.at(1).world_from_object, reflected);
    EXPECT_TRUE(hasNotice(*by_scale, "without its normal map"));
}

/** The scene of a file at a time after the start, by one of its animations. */
types::Snapshot playedAt(const std::shared_ptr<const Scene>& scene, const std::string& animation, double seconds) {
    types::Diagnostics diagnostics;
    Animator animator(scene, {{animation, {}}, {"*", {.play = false}}}, {}, diagnostics);
    EXPECT_TRUE(diagnostics.empty());
    animator.take(seconds, {});
    types::Snapshot snapshot;
    snapshot.geometry = scene->geometry;
    animator.addMoved(snapshot.moved);
    animator.addDeformed(snapshot);
    return snapshot;
}

TEST_F(CorpusTest, AFoxWalks) {
    const auto scene = std::make_shared<const Scene>(readScene(models_ / "valid/Fox/Fox.gltf"));
    ASSERT_TRUE(scene->animations);
    ASSERT_EQ(scene->animations->all.size(), 3u);
    const double duration = scene->animations->all[1].duration;
    EXPECT_EQ(scene->animations->all[1].name, "Walk");
    const Bounds rest = getBounds(*scene->geometry);
    for (const double share : {0.0, 0.3, 0.7}) {
        const types::Snapshot snapshot = playedAt(scene, "Walk", share * duration);
        ASSERT_EQ(snapshot.deformed.size(), 1u);
        const auto posed = types::posedGeometry(snapshot);
        expectSoundMesh(posed->meshes[1], posed->materials.size());
        const Bounds bounds = getBounds(*posed);
        const double size = glm::length(bounds.high - bounds.low) / glm::length(rest.high - rest.low);
        EXPECT_NEAR(size, 1, 0.15) << share;
        EXPECT_NE(posed->meshes[1].positions, scene->geometry->meshes[0].positions);
    }
    const auto first = playedAt(scene, "Walk", 0), again = playedAt(scene, "Walk", duration);
    EXPECT_EQ(types::posedGeometry(first)->meshes[1].positions, types::posedGeometry(again)->meshes[1].positions);
}

TEST_F(CorpusTest, TheWheelsOfATruckTurn) {
    const auto scene = std::make_shared<const Scene>(readScene(models_ / "valid/CesiumMilkTruck/CesiumMilkTruck.glb"));
    const types::Snapshot snapshot = playedAt(scene, scene->animations->all.at(0).name, 0.4);
    EXPECT_EQ(snapshot.moved.size(), 2u);
    EXPECT_TRUE(snapshot.deformed.empty());
    for (const types::MovedObject& wheel : snapshot.moved) {
        const glm::dmat4& rest = scene->geometry->objects[wheel.object].world_from_object;
        EXPECT_NE(wheel.world_from_object, rest);
        EXPECT_LT(glm::distance(wheel.world_from_object[3], rest[3]), 1e-9);
        EXPECT_TRUE(wheel.rate.has_value());
    }
}

TEST_F(CorpusTest, AModelWithANormalMapHasTangents) {
    const auto bottle = load("valid/WaterBottle/WaterBottle.gltf");
    EXPECT_EQ(bottle->normal_maps.size(), 1u);
    EXPECT_FALSE(bottle->meshes.at(0).tangents.empty());
}

}  // namespace
}  // namespace insonify::scene
