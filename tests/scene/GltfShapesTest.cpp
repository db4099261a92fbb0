// Triangles in every encoding that glTF has.
#include "tests/scene/SceneFiles.hpp"

namespace insonify::scene {
namespace {

const std::string square = toBytes<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
const std::string one_node = R"("nodes":[{"mesh":0}],)";

struct GltfShapesTest : SceneFiles {
    /** The square as a primitive of this mode, with these indices. */
    types::GeometryPtr makeSquare(int mode, const std::string& indices, int component_type, size_t count) const {
        return load(one_node + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":)" +
                    std::to_string(mode) + R"(}]}],"accessors":[
                    {"bufferView":0,"componentType":5126,"type":"VEC3","count":4},
                    {"bufferView":1,"componentType":)" +
                    std::to_string(component_type) + R"(,"type":"SCALAR","count":)" + std::to_string(count) +
                    R"(}],"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":)" +
                    std::to_string(indices.size()) + "}]," + buffers(square + indices));
    }
    /** Area of the triangles with the sign of their z-up normal's y: -1 for a unit square that faced +z in the file. */
    static double signedArea(const types::Geometry& geometry) {
        const auto corners = worldCorners(geometry);
        double area = 0;
        for (size_t i = 0; i < corners.size(); i += 3)
            area += glm::cross(corners[i + 1] - corners[i], corners[i + 2] - corners[i]).y / 2;
        return area;
    }
};

TEST_F(GltfShapesTest, ListStripAndFanMakeTheSameSquareWithTheSameFront) {
    const auto list = makeSquare(4, toBytes<uint16_t>({0, 1, 2, 2, 1, 3}), 5123, 6);
    const auto strip = makeSquare(5, toBytes<uint16_t>({0, 1, 2, 3}), 5123, 4);
    const auto fan = makeSquare(6, toBytes<uint16_t>({0, 1, 3, 2}), 5123, 4);
    for (const auto& geometry : {list, strip, fan}) {
        expectSound(*geometry);
        EXPECT_EQ(geometry->triangleCount(), 2u);
        EXPECT_DOUBLE_EQ(signedArea(*geometry), -1);
    }
}

TEST_F(GltfShapesTest, IndicesMayHaveOneTwoOrFourBytes) {
    for (const auto& geometry : {makeSquare(4, toBytes<uint8_t>({0, 1, 2, 2, 1, 3}), 5121, 6),
                                 makeSquare(4, toBytes<uint16_t>({0, 1, 2, 2, 1, 3}), 5123, 6),
                                 makeSquare(4, toBytes<uint32_t>({0, 1, 2, 2, 1, 3}), 5125, 6)})
        EXPECT_DOUBLE_EQ(signedArea(*geometry), -1);
}

TEST_F(GltfShapesTest, MaxIndexRestartsAStripButIsOutOfRangeInAList) {
    const auto restarted = makeSquare(5, toBytes<uint16_t>({0, 1, 2, 0xffff, 2, 1, 3}), 5123, 7);
    EXPECT_EQ(restarted->triangleCount(), 2u);
    EXPECT_DOUBLE_EQ(signedArea(*restarted), -1);
    EXPECT_THROW(makeSquare(4, toBytes<uint16_t>({0, 1, 0xffff}), 5123, 3), types::ConfigError);
}

TEST_F(GltfShapesTest, OmitsPointsAndLinesWithANotice) {
    const auto points = makeSquare(0, toBytes<uint16_t>({0, 1, 2}), 5123, 3);
    EXPECT_EQ(points->triangleCount(), 0u);
    EXPECT_TRUE(hasNotice(*points, "points or lines"));
    EXPECT_TRUE(hasNotice(*points, "an empty sea"));
}

TEST_F(GltfShapesTest, TrianglesNeedNoIndices) {
    const auto geometry = load(one_node + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
        "bufferViews":[{"buffer":0,"byteLength":48}],)" +
                               buffers(square));
    EXPECT_EQ(geometry->triangleCount(), 1u);
    EXPECT_EQ(geometry->materials.size(), 1u);
    EXPECT_FALSE(geometry->materials[0].has_acoustics);
}

TEST_F(GltfShapesTest, InterleavedAttributesAreReadWithTheirStride) {
    const auto geometry = load(one_node + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"byteOffset":4,"componentType":5126,"type":"VEC3","count":3}],
        "bufferViews":[{"buffer":0,"byteLength":48,"byteStride":16}],)" +
                               buffers(toBytes<float>({9, 0, 0, 0, 9, 2, 0, 0, 9, 0, 3, 0})));
    EXPECT_EQ(getBounds(*geometry).high, glm::dvec3(2, 0, 3));
}

TEST_F(GltfShapesTest, SparseValuesReplaceBaseValuesAndAnAbsentBaseIsZero) {
    const std::string sparse =
        R"("sparse":{"count":2,"indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":2}}}],
        "bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":2},
                       {"buffer":0,"byteOffset":52,"byteLength":24}],)" +
        buffers(square + toBytes<uint8_t>({1, 2, 0, 0}) + toBytes<float>({5, 0, 0, 0, 7, 0}));
    const std::string mesh = one_node + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{)";
    const std::string accessor = R"("componentType":5126,"type":"VEC3","count":3,)";
    EXPECT_EQ(getBounds(*load(mesh + R"("bufferView":0,)" + accessor + sparse)).high, glm::dvec3(5, 0, 7));
    EXPECT_EQ(getBounds(*load(mesh + accessor + sparse)).high, glm::dvec3(5, 0, 7));
}

TEST_F(GltfShapesTest, AZeroFilledMeshHasNoAreaAndIsAnEmptySea) {
    const auto geometry = load(one_node + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"componentType":5126,"type":"VEC3","count":3}])");
    EXPECT_EQ(geometry->triangleCount(), 0u);
    EXPECT_TRUE(hasNotice(*geometry, "no area: 1"));
}

TEST_F(GltfShapesTest, QuantisedPositionsAreScaledOnlyWhenNormalised) {
    const auto quantised = [this](const char* normalized) {
        return getBounds(*load(
            one_node + R"("extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
            "accessors":[{"bufferView":0,"componentType":5122,"normalized":)" +
            std::string(normalized) +
            R"(,"type":"VEC3","count":3}],"bufferViews":[{"buffer":0,"byteLength":24,"byteStride":8}],)" +
            buffers(toBytes<int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, 0, -32768, 0, 0}))));
    };
    EXPECT_EQ(quantised("true").high.x, 1);
    EXPECT_EQ(quantised("true").low.z, -1);
    EXPECT_EQ(quantised("false").high.x, 32767);
    EXPECT_EQ(quantised("false").low.z, -32768);
}

TEST_F(GltfShapesTest, TrianglesWithDamagedVerticesAreDroppedAndCountedOnce) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const auto geometry = load(one_node + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":9}],
        "bufferViews":[{"buffer":0,"byteLength":108}],)" +
                               buffers(square.substr(0, 36) + toBytes<float>({nan, 0, 0, 1, 0, 0, 0, 1, 0}) +
                                       toBytes<float>({0, 0, 0, inf, 0, 0, 0, 1, 0})));
    expectSound(*geometry);
    EXPECT_EQ(geometry->triangleCount(), 1u);
    EXPECT_TRUE(hasNotice(*geometry, "not a finite number: 2"));
}

}  // namespace
}  // namespace insonify::scene
