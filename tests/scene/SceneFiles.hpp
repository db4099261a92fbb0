#pragma once
// Small glTF files made inside a test, and checks that apply to every loaded scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <vector>

#include "components/scene/Scene.hpp"
#include "tests/support/Base64.hpp"
#include "tests/support/Folder.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::scene {

template <class T>
std::string toBytes(std::initializer_list<T> values) {
    return test::toBytes(std::span(values));
}

/** `"buffers":[...]` of one buffer with these bytes. */
inline std::string buffers(const std::string& bytes) {
    return R"("buffers":[{"byteLength":)" + std::to_string(bytes.size()) +
           R"(,"uri":"data:application/octet-stream;base64,)" + test::base64(bytes) + R"("}])";
}

/** `"accessors":[...],"bufferViews":[...],"buffers":[...]`: accessor 0 is the corners of a triangle. */
inline std::string triangle(const std::string& corners = toBytes<float>({0, 0, 0, 1, 0, 0, 0, 1, 0})) {
    return R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
        "bufferViews":[{"buffer":0,"byteLength":36}],)" +
           buffers(corners);
}

/** Has a separate folder for each test. */
struct SceneFiles : ::testing::Test {
    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        std::filesystem::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return folder_ / name;
    }
    /** Loads `{"asset":{"version":"2.0"},` + rest + `}`. */
    types::GeometryPtr load(const std::string& rest) const { return loadScene(write("case.gltf", gltf(rest))); }
    static std::string gltf(const std::string& rest) { return R"({"asset":{"version":"2.0"},)" + rest + "}"; }
    /** Returns the diagnostic of a file; empty if there is none. */
    std::string findDiagnostic(const std::filesystem::path& file) const {
        try {
            loadScene(file);
            return "";
        } catch (const types::ConfigError& error) {
            return error.what();
        }
    }
    std::string diagnosticOfGltf(const std::string& rest) const {
        return findDiagnostic(write("case.gltf", gltf(rest)));
    }

    const Folder owned_;
    const std::filesystem::path folder_ = owned_.path();
};

inline std::vector<glm::dvec3> worldCorners(const types::Geometry& geometry, const types::Object& object) {
    std::vector<glm::dvec3> corners;
    const types::Mesh& mesh = geometry.meshes[static_cast<size_t>(object.mesh)];
    for (const uint32_t index : mesh.indices)
        corners.emplace_back(object.world_from_object * glm::dvec4(mesh.positions[index], 1));
    return corners;
}
inline std::vector<glm::dvec3> worldCorners(const types::Geometry& geometry) {
    std::vector<glm::dvec3> corners;
    for (const types::Object& object : geometry.objects)
        for (const glm::dvec3 corner : worldCorners(geometry, object)) corners.push_back(corner);
    return corners;
}

struct Bounds {
    glm::dvec3 low{1e300}, high{-1e300};
};
/** Bounds of the whole geometry, or of one object given after it. */
template <class... Object>
Bounds getBounds(const types::Geometry& geometry, const Object&... object) {
    Bounds bounds;
    for (const glm::dvec3 corner : worldCorners(geometry, object...)) {
        bounds.low = glm::min(bounds.low, corner);
        bounds.high = glm::max(bounds.high, corner);
    }
    return bounds;
}

inline bool isFinite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

inline void expectSoundMesh(const types::Mesh& mesh, size_t material_count) {
    for (const uint32_t index : mesh.indices) ASSERT_LT(index, mesh.positions.size());
    for (const glm::vec3 position : mesh.positions) ASSERT_TRUE(isFinite(position));
    for (const glm::vec3 normal : mesh.normals) ASSERT_NEAR(glm::length(normal), 1, 1e-4);
    for (const glm::vec4 tangent : mesh.tangents) ASSERT_NEAR(glm::length(glm::vec3(tangent)), 1, 1e-4);
    for (const glm::vec2 uv : mesh.uvs) ASSERT_TRUE(std::isfinite(uv.x) && std::isfinite(uv.y));
    const auto none_or_all = [&mesh](size_t size) { return size == 0 || size == mesh.positions.size(); };
    EXPECT_TRUE(none_or_all(mesh.normals.size()) && none_or_all(mesh.tangents.size()) && none_or_all(mesh.uvs.size()));
    size_t next = 0;
    for (const types::Cluster& cluster : mesh.clusters) {
        EXPECT_EQ(cluster.first_index, next);
        EXPECT_GT(cluster.index_count, 0u);
        EXPECT_EQ(cluster.index_count % 3, 0u);
        EXPECT_TRUE(cluster.material >= 0 && static_cast<size_t>(cluster.material) < material_count);
        next += cluster.index_count;
        ASSERT_LE(next, mesh.indices.size());
        for (size_t i = cluster.first_index; i < next; ++i) {
            const glm::vec3 away = glm::abs(mesh.positions[mesh.indices[i]] - cluster.centre);
            ASSERT_TRUE(away.x <= cluster.half.x && away.y <= cluster.half.y && away.z <= cluster.half.z);
        }
    }
    EXPECT_EQ(next, mesh.indices.size());
}

/** Expects the guarantees of types::Geometry. */
inline void expectSound(const types::Geometry& geometry) {
    std::vector<std::string> names;
    for (const types::Object& object : geometry.objects) {
        ASSERT_TRUE(object.mesh >= 0 && static_cast<size_t>(object.mesh) < geometry.meshes.size());
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r) ASSERT_TRUE(std::isfinite(object.world_from_object[c][r]));
        names.push_back(object.name);
    }
    std::ranges::sort(names);
    EXPECT_TRUE(std::ranges::adjacent_find(names) == names.end());
    for (const types::Mesh& mesh : geometry.meshes) expectSoundMesh(mesh, geometry.materials.size());
    for (const types::Material& material : geometry.materials)
        EXPECT_LT(material.normal_map, static_cast<int>(geometry.normal_maps.size()));
    for (const types::NormalMap& map : geometry.normal_maps)
        EXPECT_EQ(map.rgb.size(), size_t{3} * static_cast<size_t>(map.width) * static_cast<size_t>(map.height));
}

inline bool hasNotice(const types::Geometry& geometry, const std::string& part) {
    return std::ranges::any_of(
        geometry.notices, [&](const types::Notice& notice) { return notice.text.find(part) != std::string::npos; });
}

}  // namespace insonify::scene
