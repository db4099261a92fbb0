// One cube in several encodings of glTF: the pings are the same, bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/scene/SceneFiles.hpp"
#include "tests/support/Scenes.hpp"

namespace insonify::sonar {
namespace {

using scene::toBytes;

/** Corner i of a cube from -1 to 1. */
std::array<int, 3> corner(int i) { return {i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1}; }

const std::initializer_list<int> triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                              2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
const std::initializer_list<int> strips = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 4, 5, 2, 3, 6, 7, 0, 2, 4, 6, 1, 3, 5, 7};

/** Positions of corners as numbers of type T, each followed by `more`. */
template <class T, class Corners>
std::string positions(const Corners& corners, const std::string& more = {}) {
    std::string bytes;
    for (int i : corners) {
        for (int value : corner(i)) bytes += toBytes({static_cast<T>(value)});
        bytes += more;
    }
    return bytes;
}

template <class T>
std::string indices(const std::initializer_list<int>& corners) {
    std::string bytes;
    for (int i : corners) bytes += toBytes({static_cast<T>(i)});
    return bytes;
}

const std::array<int, 8> each = {0, 1, 2, 3, 4, 5, 6, 7};
const std::string turned_cube = R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"cube","mesh":0,
    "translation":[8,-1,-2],"rotation":[0.18,0.36,0.54,0.738783],"scale":[1,2,1.5]}],)";
const std::string one_primitive = R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)";

std::string view(size_t offset, size_t bytes, const std::string& more = {}) {
    return R"({"buffer":0,"byteOffset":)" + std::to_string(offset) + R"(,"byteLength":)" + std::to_string(bytes) +
           more + "}";
}

std::string accessor(int buffer_view, int component, size_t count, const std::string& more) {
    return R"({"bufferView":)" + std::to_string(buffer_view) + R"(,"componentType":)" + std::to_string(component) +
           R"(,"count":)" + std::to_string(count) + "," + more + "}";
}

const std::string vec3 = R"("type":"VEC3","min":[-1,-1,-1],"max":[1,1,1])", scalar = R"("type":"SCALAR")";

/** Eight corners of `stride` bytes and 36 indices of a type. */
std::string indexed(size_t stride, int position_type, int index_type, size_t index_bytes) {
    const std::string spaced = stride == 12 ? "" : R"(,"byteStride":)" + std::to_string(stride);
    return turned_cube + one_primitive + R"("accessors":[)" + accessor(0, position_type, 8, vec3) + "," +
           accessor(1, index_type, 36, scalar) + R"(],"bufferViews":[)" + view(0, 8 * stride, spaced) + "," +
           view(8 * stride, 36 * index_bytes) + "],";
}

struct EncodingsTest : scene::SceneFiles {
    std::vector<float> makePing(const std::string& rest) const { return makePing(load(rest)); }
    static std::vector<float> makePing(const types::GeometryPtr& geometry) {
        SonarConfig config;
        config.range = 15;
        config.bin_count = 200;
        config.beam_count = 64;
        config.field_of_view_deg = 70;
        config.beam_height_deg = 50;
        config.quality.rows = 128;
        config.device = "software";
        SonarRenderer renderer(config, geometry);
        types::Sonar ping;
        renderer.render(test::makeSnapshot(geometry, {0, 0, -1}, 0.1), ping);
        return ping.bins;
    }
    /** Writes a .gltf with the bytes in a data URI, shared corners of floats and 16-bit indices. */
    std::vector<float> plain() const {
        const auto bins = makePing(indexed(12, 5126, 5123, 2) +
                                   scene::buffers(positions<float>(each) + indices<uint16_t>(triangles)));
        EXPECT_GT(std::ranges::count_if(bins, [](float x) { return x > 0; }), 200);
        return bins;
    }
};

std::string word(size_t value) { return toBytes({static_cast<uint32_t>(value)}); }

std::string padded(std::string bytes, char with) {
    bytes.resize((bytes.size() + 3) / 4 * 4, with);
    return bytes;
}

}  // namespace

TEST_F(EncodingsTest, ABinaryFileIsTheTextWithADataUri) {
    const std::string data = padded(positions<float>(each) + indices<uint16_t>(triangles), '\0');
    const std::string json = padded(
        gltf(indexed(12, 5126, 5123, 2) + R"("buffers":[{"byteLength":)" + std::to_string(data.size()) + "}]"), ' ');
    const std::string glb = "glTF" + word(2) + word(12 + 8 + json.size() + 8 + data.size()) + word(json.size()) +
                            "JSON" + json + word(data.size()) + std::string("BIN\0", 4) + data;
    EXPECT_EQ(makePing(scene::loadScene(write("cube.glb", glb))), plain());
}

TEST_F(EncodingsTest, InterleavedCornersWithByteIndicesAreTheSame) {
    const std::string normal = toBytes({0.0f, 0.0f, 1.0f});
    EXPECT_EQ(makePing(indexed(24, 5126, 5121, 1) +
                       scene::buffers(positions<float>(each, normal) + indices<uint8_t>(triangles))),
              plain());
}

TEST_F(EncodingsTest, QuantizedCornersWithWordIndicesAreTheSame) {
    const std::string extension =
        R"("extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"],)";
    EXPECT_EQ(makePing(extension + indexed(4, 5120, 5125, 4) +
                       scene::buffers(positions<int8_t>(each, std::string(1, '\0')) + indices<uint32_t>(triangles))),
              plain());
}

TEST_F(EncodingsTest, TrianglesWithoutIndicesAreTheSame) {
    const std::string data = positions<float>(triangles);
    EXPECT_EQ(makePing(turned_cube + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[)" +
                       accessor(0, 5126, 36, vec3) + R"(],"bufferViews":[)" + view(0, data.size()) + "]," +
                       scene::buffers(data)),
              plain());
}

TEST_F(EncodingsTest, SixStripsAreTheSame) {
    const std::string corners = positions<float>(each);
    std::string primitives, accessors = accessor(0, 5126, 8, vec3);
    for (int face = 0; face < 6; ++face) {
        primitives += std::string(face ? "," : "") + R"({"mode":5,"attributes":{"POSITION":0},"indices":)" +
                      std::to_string(face + 1) + "}";
        accessors += "," + accessor(1, 5121, 4, scalar + R"(,"byteOffset":)" + std::to_string(4 * face));
    }
    EXPECT_EQ(makePing(turned_cube + R"("meshes":[{"primitives":[)" + primitives + R"(]}],"accessors":[)" + accessors +
                       R"(],"bufferViews":[)" + view(0, corners.size()) + "," + view(corners.size(), 24) + "]," +
                       scene::buffers(corners + indices<uint8_t>(strips))),
              plain());
}

TEST_F(EncodingsTest, ACubeOfOtherCornersIsNot) {
    std::string corners = positions<float>(each);
    corners.replace(0, 4, toBytes({-1.01f}));
    EXPECT_NE(makePing(indexed(12, 5126, 5123, 2) + scene::buffers(corners + indices<uint16_t>(triangles))), plain());
}

}  // namespace insonify::sonar
