// Places of meshes by their nodes, and names of objects.
#include <glm/gtc/matrix_transform.hpp>

#include "tests/scene/SceneFiles.hpp"

namespace insonify::scene {
namespace {

/** One triangle (0,0,0) (1,0,0) (0,2,0) as mesh 0. */
const std::string triangle_mesh = R"("meshes":[{"name":"tri","primitives":[{"attributes":{"POSITION":0}}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
    "bufferViews":[{"buffer":0,"byteLength":36}],)" +
                                  buffers(toBytes<float>({0, 0, 0, 1, 0, 0, 0, 2, 0}));

struct GltfNodesTest : SceneFiles {
    types::GeometryPtr nodes(const std::string& json) const { return load(R"("nodes":)" + json + "," + triangle_mesh); }
    std::string diagnosticOfNodes(const std::string& json) const {
        return diagnosticOfGltf(R"("nodes":)" + json + "," + triangle_mesh);
    }
};

glm::dvec3 worldPoint(const types::Object& object, glm::dvec3 point) {
    return glm::dvec3(object.world_from_object * glm::dvec4(point, 1));
}

void expectNear(glm::dvec3 a, glm::dvec3 b) {
    EXPECT_LT(glm::distance(a, b), 1e-12) << a.x << " " << a.y << " " << a.z;
}

TEST_F(GltfNodesTest, YUpBecomesZUp) {
    const auto geometry = nodes(R"([{"mesh":0,"translation":[1,2,3]}])");
    expectNear(worldPoint(geometry->objects[0], {0, 0, 0}), {1, -3, 2});
    expectNear(worldPoint(geometry->objects[0], {0, 2, 0}), {1, -3, 4});
}

TEST_F(GltfNodesTest, TranslationRotationAndScaleComposeDownTheTree) {
    const auto geometry =
        nodes(R"([{"children":[1],"translation":[10,0,0],"rotation":[0,0,0.7071067811865476,0.7071067811865476]},
                                    {"mesh":0,"translation":[1,0,0],"scale":[2,3,4]}])");
    // x of the child is y of the file, which is z of the world
    expectNear(worldPoint(geometry->objects[0], {1, 0, 0}), {10, 0, 3});
    expectNear(worldPoint(geometry->objects[0], {0, 2, 0}), {4, 0, 1});
}

TEST_F(GltfNodesTest, AMatrixIsTakenColumnByColumn) {
    const auto geometry = nodes(R"([{"mesh":0,"matrix":[2,0,0,0, 0,3,0,0, 0,0,4,0, 5,6,7,1]}])");
    expectNear(worldPoint(geometry->objects[0], {1, 2, 0}), {7, -7, 12});
}

TEST_F(GltfNodesTest, ANegativeScaleMirrors) {
    const auto geometry = nodes(R"([{"mesh":0,"scale":[-1,1,1]}])");
    EXPECT_LT(glm::determinant(geometry->objects[0].world_from_object), 0);
    expectNear(worldPoint(geometry->objects[0], {1, 0, 0}), {-1, 0, 0});
}

TEST_F(GltfNodesTest, ARotationThatIsNotOfUnitLengthIsNormalised) {
    const auto geometry = nodes(R"([{"mesh":0,"rotation":[0,0,0,3]}])");
    expectNear(worldPoint(geometry->objects[0], {1, 0, 0}), {1, 0, 0});
}

TEST_F(GltfNodesTest, NodesShareAMeshAndHaveNamesOfTheirOwn) {
    const auto geometry = nodes(R"([{"mesh":0,"name":"pile"},{"mesh":0,"name":"pile"},{"mesh":0}])");
    expectSound(*geometry);
    EXPECT_EQ(geometry->meshes.size(), 1u);
    ASSERT_EQ(geometry->objects.size(), 3u);
    EXPECT_EQ(geometry->objects[0].name, "pile");
    EXPECT_EQ(geometry->objects[1].name, "pile_2");
    EXPECT_EQ(geometry->objects[2].name, "tri");
    EXPECT_TRUE(hasNotice(*geometry, "1 node has the name of another and gets a number: pile is pile_2"));
    const auto unnamed = nodes(R"([{"mesh":0},{"mesh":0}])");
    EXPECT_EQ(unnamed->objects[1].name, "tri_2");
    EXPECT_FALSE(hasNotice(*unnamed, "the name of another"));
}

TEST_F(GltfNodesTest, InstancesOfAnExtensionAreObjects) {
    const auto geometry =
        load(R"("extensionsUsed":["EXT_mesh_gpu_instancing"],"extensionsRequired":["EXT_mesh_gpu_instancing"],
        "nodes":[{"mesh":0,"name":"rocks","extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
        "bufferViews":[{"buffer":0,"byteLength":36}],)" +
             buffers(toBytes<float>({0, 0, 0, 1, 0, 0, 0, 2, 0})));
    ASSERT_EQ(geometry->objects.size(), 3u);
    EXPECT_EQ(geometry->objects[1].name, "rocks[1]");
    expectNear(worldPoint(geometry->objects[2], {0, 0, 0}), {0, 0, 2});
}

TEST_F(GltfNodesTest, OnlyTheDefaultSceneIsLoaded) {
    const auto geometry = load(R"("scene":1,"scenes":[{"nodes":[0,1]},{"nodes":[1]}],
        "nodes":[{"mesh":0,"name":"a"},{"mesh":0,"name":"b"}],)" +
                               triangle_mesh);
    ASSERT_EQ(geometry->objects.size(), 1u);
    EXPECT_EQ(geometry->objects[0].name, "b");
}

TEST_F(GltfNodesTest, AChainOfManyNodesDoesNotOverflowTheStack) {
    std::string chain = "[";
    for (int i = 1; i < 50'000; ++i) chain += R"({"children":[)" + std::to_string(i) + "]},";
    const auto geometry = nodes(chain + R"({"mesh":0}])");
    EXPECT_EQ(geometry->objects.size(), 1u);
}

TEST_F(GltfNodesTest, CyclesSecondParentsAndWrongIndicesAreRefused) {
    EXPECT_NE(diagnosticOfGltf(R"("scenes":[{"nodes":[0]}],"nodes":[{"children":[0]}])").find("reached twice"),
              std::string::npos);
    EXPECT_NE(diagnosticOfNodes(R"([{"children":[2]},{"children":[2]},{"mesh":0}])").find("nodes[2]"),
              std::string::npos);
    EXPECT_NE(diagnosticOfNodes(R"([{"children":[7]}])").find("nodes[7]: does not exist"), std::string::npos);
    EXPECT_NE(diagnosticOfNodes(R"([{"mesh":5}])").find("nodes[0].mesh: is 5"), std::string::npos);
    EXPECT_NE(diagnosticOfGltf(R"("scene":3,"scenes":[{"nodes":[]}])").find("scene: is 3"), std::string::npos);
}

TEST_F(GltfNodesTest, InvalidTransformsAreRefused) {
    EXPECT_NE(diagnosticOfNodes(R"([{"mesh":0,"translation":[1,2]}])").find("has 2 numbers; must have 3"),
              std::string::npos);
    EXPECT_NE(diagnosticOfNodes(R"([{"mesh":0,"rotation":[0,0,0,0]}])").find("has no length"), std::string::npos);
    EXPECT_NE(diagnosticOfNodes(R"([{"children":[1],"scale":[1e300,1,1]},{"mesh":0,"scale":[1e300,1,1]}])")
                  .find("not finite"),
              std::string::npos);
}

TEST_F(GltfNodesTest, OmitsAnObjectOfScaleZeroWithANotice) {
    const auto geometry = nodes(R"([{"mesh":0,"scale":[1,0,1]}])");
    EXPECT_TRUE(geometry->objects.empty());
    EXPECT_TRUE(hasNotice(*geometry, "scale is zero"));
}

TEST_F(GltfNodesTest, APartIsTheNodeWithoutItsPlaceAndRotationButWithItsScale) {
    const Scene scene = readScene(write("case.gltf", gltf(R"("nodes":[
        {"name":"boat","mesh":0,"translation":[9,9,9],"rotation":[0.6,0,0,0.8],"scale":[-2,3,4],"children":[1]},
        {"name":"mast","mesh":0,"translation":[0,5,0]},{"name":"quay","mesh":0}],)" +
                                                          triangle_mesh)));
    const std::vector<Part> parts = getParts(scene, findNode(scene, "boat"));
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(scene.geometry->objects[parts[1].object].name, "mast");
    const auto at = [](const Part& part, glm::dvec3 p) { return glm::dvec3(part.body_from_object * glm::dvec4(p, 1)); };
    expectNear(at(parts[0], {1, 2, 1}), {-2, -4, 6});
    expectNear(at(parts[1], {0, 0, 0}), {0, 0, 15});
}

TEST_F(GltfNodesTest, AMatrixNodeKeepsItsMirrorAsAPart) {
    const Scene scene = readScene(write("case.gltf", gltf(R"("nodes":[
        {"name":"m","mesh":0,"matrix":[-2,0,0,0, 0,1,0,0, 0,0,1,0, 3,4,5,1]}],)" +
                                                          triangle_mesh)));
    const Part part = getParts(scene, 0).at(0);
    expectNear(glm::dvec3(part.body_from_object * glm::dvec4(1, 1, 0, 1)), {-2, 0, 1});
}

}  // namespace
}  // namespace insonify::scene
