#pragma once
// glTF with animations, skins and morph targets, made inside a test.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tests/scene/SceneFiles.hpp"

namespace insonify::scene {

/** Collects the arrays of a file. */
class Arrays {
public:
    int floats(const std::string& type, const std::vector<float>& values) {
        return add(type, 5126, values, computeWidth(type));
    }
    int shorts(const std::string& type, const std::vector<uint16_t>& values) {
        return add(type, 5123, values, computeWidth(type));
    }
    int indices(const std::vector<uint32_t>& values) { return add("SCALAR", 5125, values, 1); }

    /** `"accessors":[...],"bufferViews":[...],"buffers":[...]` */
    std::string text() const {
        return fmt::format(R"("accessors":[{}],"bufferViews":[{}],{})", fmt::join(accessors_, ","),
                           fmt::join(views_, ","), buffers(bytes_));
    }

private:
    static size_t computeWidth(const std::string& type) {
        return type == "SCALAR" ? 1 : type == "MAT4" ? 16 : static_cast<size_t>(type.back() - '0');
    }
    template <class T>
    int add(const std::string& type, int component, const std::vector<T>& values, size_t width) {
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
        views_.push_back(
            fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":{}}})", bytes_.size(), values.size() * sizeof(T)));
        accessors_.push_back(fmt::format(R"({{"bufferView":{},"componentType":{},"type":"{}","count":{}}})",
                                         views_.size() - 1, component, type, values.size() / width));
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        return static_cast<int>(accessors_.size()) - 1;
    }

    std::string bytes_;
    std::vector<std::string> views_, accessors_;
};

/** A tube along x of the file, of `rings` rings of `sides` corners about places 0 to 1; closed at both ends. */
struct Tube {
    std::vector<float> positions;
    std::vector<uint32_t> indices;

    Tube(uint32_t rings, uint32_t sides, float radius) {
        for (uint32_t ring = 0; ring < rings; ++ring)
            for (uint32_t side = 0; side < sides; ++side) {
                const float angle = 6.2831853f * static_cast<float>(side) / static_cast<float>(sides);
                positions.insert(positions.end(), {static_cast<float>(ring) / static_cast<float>(rings - 1),
                                                   radius * std::cos(angle), radius * 1.3f * std::sin(angle)});
            }
        positions.insert(positions.end(), {-radius, 0, 0, 1 + radius, 0, 0});
        const auto at = [&](uint32_t ring, uint32_t side) { return ring * sides + side % sides; };
        for (uint32_t ring = 0; ring + 1 < rings; ++ring)
            for (uint32_t side = 0; side < sides; ++side)
                indices.insert(indices.end(), {at(ring, side), at(ring, side + 1), at(ring + 1, side),
                                               at(ring, side + 1), at(ring + 1, side + 1), at(ring + 1, side)});
        for (uint32_t side = 0; side < sides; ++side)
            indices.insert(indices.end(), {rings * sides, at(0, side + 1), at(0, side), rings * sides + 1,
                                           at(rings - 1, side), at(rings - 1, side + 1)});
    }
    size_t count() const { return positions.size() / 3; }
};

/** A tube with a skin of three joints: `waves` turns the last two, `advance` moves the root. Nodes: 0 "eel" above all,
 * 1 "skin" with the mesh, 2 to 4 "joint_0" and on. */
inline std::string eelText(const Tube& tube, const std::string& more_nodes = "") {
    Arrays arrays;
    const int positions = arrays.floats("VEC3", tube.positions), indices = arrays.indices(tube.indices);
    std::vector<uint16_t> joints;
    std::vector<float> weights;
    for (size_t i = 0; i < tube.count(); ++i) {
        const float at = std::clamp(2 * tube.positions[3 * i], 0.0f, 2.0f);
        const auto before = static_cast<uint16_t>(std::min(at, 1.0f));
        const float share = at - static_cast<float>(before);
        joints.insert(joints.end(), {before, static_cast<uint16_t>(before + 1), 0, 0});
        weights.insert(weights.end(), {1 - share, share, 0, 0});
    }
    const int joints_0 = arrays.shorts("VEC4", joints), weights_0 = arrays.floats("VEC4", weights);
    std::vector<float> matrices;
    for (int i = 0; i < 3; ++i) {
        const std::vector<float> one{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -0.5f * static_cast<float>(i), 0, 0, 1};
        matrices.insert(matrices.end(), one.begin(), one.end());
    }
    const int inverse = arrays.floats("MAT4", matrices);
    const int times = arrays.floats("SCALAR", {0, 0.25f, 0.75f, 1});
    const int turns = arrays.floats("VEC4", {0, 0, 0, 1, 0, 0.3f, 0, 0.953939f, 0, -0.3f, 0, 0.953939f, 0, 0, 0, 1});
    const int long_times = arrays.floats("SCALAR", {0, 2});
    const int way = arrays.floats("VEC3", {0, 0, 0, 1, 0.25f, 0});
    return fmt::format(
               R"("scenes":[{{"nodes":[0]}}],
        "nodes":[{{"name":"eel","children":[1,2]}},{{"name":"skin","mesh":0,"skin":0}},
                 {{"name":"joint_0","children":[3]}},{{"name":"joint_1","translation":[0.5,0,0],"children":[4]}},
                 {{"name":"joint_2","translation":[0.5,0,0]}}{}],
        "meshes":[{{"name":"tube","primitives":[{{"attributes":{{"POSITION":{},"JOINTS_0":{},"WEIGHTS_0":{}}},"indices":{}}}]}}],
        "skins":[{{"joints":[2,3,4],"inverseBindMatrices":{}}}],
        "animations":[{{"name":"waves","samplers":[{{"input":{},"output":{}}}],
                       "channels":[{{"sampler":0,"target":{{"node":3,"path":"rotation"}}}},
                                   {{"sampler":0,"target":{{"node":4,"path":"rotation"}}}}]}},
                      {{"name":"advance","samplers":[{{"input":{},"output":{}}}],
                       "channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}}]}}],)",
               more_nodes, positions, joints_0, weights_0, indices, inverse, times, turns, long_times, way) +
           arrays.text();
}

/** A tube with two morph targets, `bends` of which moves the weights; default weights 0.25 and 0. */
inline std::string kelpText(const Tube& tube) {
    Arrays arrays;
    const int positions = arrays.floats("VEC3", tube.positions), indices = arrays.indices(tube.indices);
    std::vector<float> first, second;
    for (size_t i = 0; i < tube.count(); ++i) {
        const float x = tube.positions[3 * i];
        first.insert(first.end(), {0, 0.4f * x * x, 0});
        second.insert(second.end(), {-0.1f * x, 0, 0.3f * x * x * x});
    }
    const int a = arrays.floats("VEC3", first), b = arrays.floats("VEC3", second);
    const int times = arrays.floats("SCALAR", {0, 1, 2}), weights = arrays.floats("SCALAR", {0, 0.5f, 1, 0, 0, 0.5f});
    return fmt::format(
               R"("nodes":[{{"name":"kelp","mesh":0,"translation":[5,0,0]}}],
        "meshes":[{{"weights":[0.25,0],"primitives":[{{"attributes":{{"POSITION":{}}},"indices":{},
                    "targets":[{{"POSITION":{}}},{{"POSITION":{}}}]}}]}}],
        "animations":[{{"name":"bends","samplers":[{{"input":{},"output":{}}}],
                       "channels":[{{"sampler":0,"target":{{"node":0,"path":"weights"}}}}]}}],)",
               positions, indices, a, b, times, weights) +
           arrays.text();
}

}  // namespace insonify::scene
