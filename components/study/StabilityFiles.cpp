// What a scene file may hold.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "components/scene/Acoustics.hpp"
#include "components/scene/Scene.hpp"
#include "components/study/Bounds.hpp"
#include "components/study/Probe.hpp"
#include "components/study/StabilityGroups.hpp"
#include "types/ConfigError.hpp"

namespace insonify::study {
namespace {

using Corner = std::array<float, 3>;

/** A glTF file of one mesh, y-up, in a folder that goes with it. */
class GltfFile {
public:
    /** `corners` is accessor 0; `primitive` and `rest` are JSON of the mesh's primitive and of further parts. */
    GltfFile(const std::vector<Corner>& corners, const std::string& primitive, const std::string& node = "",
             const std::string& rest = "") {
        std::string name = (std::filesystem::temp_directory_path() / "insonify_XXXXXX").string();
        if (!mkdtemp(name.data())) throw std::runtime_error("no folder for a scene in " + name);
        folder_ = name;
        const size_t bytes = corners.size() * sizeof(Corner);
        std::ofstream(folder_ / "corners.bin", std::ios::binary)
            .write(reinterpret_cast<const char*>(corners.data()), static_cast<std::streamsize>(bytes));
        std::ofstream(path()) << fmt::format(
            R"({{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0{}}}],"meshes":[{{"primitives":[{{{}}}]}}],)"
            R"("accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":{}}}],)"
            R"("bufferViews":[{{"buffer":0,"byteLength":{}}}],"buffers":[{{"byteLength":{},"uri":"corners.bin"}}]{}}})",
            node, primitive, corners.size(), bytes, bytes, rest);
    }
    ~GltfFile() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    GltfFile(const GltfFile&) = delete;
    GltfFile& operator=(const GltfFile&) = delete;
    std::filesystem::path path() const { return folder_ / "scene.gltf"; }

private:
    std::filesystem::path folder_;
};

constexpr const char* plain_primitive = R"("attributes":{"POSITION":0})";

/** Two triangles, a wall 8 m ahead; y is up in the file. */
std::vector<Corner> wall() { return {{8, -9, 9}, {8, -9, -9}, {8, 9, -9}, {8, -9, 9}, {8, 9, -9}, {8, 9, 9}}; }

Probe heardOf(const GltfFile& file) { return probe(fan(60, 30, 8, 12), lookingAt(scene::loadScene(file.path()))); }

Outcome damagedVertices() {
    std::vector<Corner> corners = wall();
    for (const float bad : {NAN, INFINITY, -INFINITY})
        corners.insert(corners.end(), {{4, 0, 0}, {bad, 1, 0}, {4, 1, 1}});
    const GltfFile good(wall(), plain_primitive), damaged(corners, plain_primitive);
    const auto notices = scene::loadScene(damaged.path())->notices;
    const bool told = std::ranges::count_if(notices, [](const std::string& n) {
                          return n.find("not a finite number: 3") != std::string::npos;
                      }) == 1;
    const Probe heard = heardOf(damaged);
    return within(0, told ? difference(heard.ping, heardOf(good).ping) : INFINITY,
                  fmt::format("three triangles with NaN and inf: dropped, {}",
                              told ? "counted in one notice; bit-identical" : "NOT reported"),
                  heard);
}

Outcome longRotation() {
    const auto turned = [](double length) {
        const double half = 0.2;  // about the file's y axis
        return fmt::format(R"(,"rotation":[0,{:.17g},0,{:.17g}])", length * std::sin(half), length * std::cos(half));
    };
    const GltfFile unit(wall(), plain_primitive, turned(1)), longer(wall(), plain_primitive, turned(1.001));
    const Probe heard = heardOf(longer);
    return within(1e-9, difference(heard.ping, heardOf(unit).ping), "a node's quaternion of length 1.001 is normalised",
                  heard);
}

/** What is wrong with a file; empty when nothing is. */
std::string faultOf(const GltfFile& file) {
    try {
        scene::loadScene(file.path());
        return "";
    } catch (const types::ConfigError& error) {
        return error.what();
    }
}

Outcome filesOfManyKinds() {
    int wrong = 0;
    const GltfFile flat({{8, 0, 0}, {8, 0, 0}, {8, 0, 0}}, plain_primitive);
    const auto empty = scene::loadScene(flat.path());
    wrong += empty->triangleCount() != 0 || empty->notices.empty() || heardOf(flat).energy() != 0;
    const GltfFile list(wall(), plain_primitive),
        strip({{8, -9, 9}, {8, -9, -9}, {8, 9, 9}, {8, 9, -9}}, R"("attributes":{"POSITION":0},"mode":5)");
    const Probe heard = heardOf(list);
    wrong += difference(heardOf(strip).ping, heard.ping) > 1e-6;
    const GltfFile packed(
        wall(), plain_primitive, "",
        R"(,"extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"])");
    wrong += faultOf(packed).find("KHR_draco_mesh_compression cannot be read") == std::string::npos;
    const GltfFile beyond(wall(), R"("attributes":{"POSITION":7})");
    wrong += faultOf(beyond).empty();
    Outcome outcome = within(
        0, wrong,
        fmt::format("an empty sea with a notice, an unindexed list as its strip, two clear errors; {} wrong", wrong),
        heard);
    return outcome;
}

Outcome reflectivityBounds() {
    int accepted = 0;
    for (const double value : {-0.1, 1.1, static_cast<double>(NAN)}) {
        scene::Acoustics acoustics;
        acoustics.reflectivity = value;
        accepted += faultsOf(acoustics).empty();
    }
    scene::Acoustics good;
    good.reflectivity = 1;
    return none(accepted + static_cast<double>(!faultsOf(good).empty()), "-0.1, 1.1 and NaN refused, 1 accepted");
}

}  // namespace

std::vector<StabilityCase> sceneFileCases() {
    return {{9, "NaN and inf in vertices", "the triangles dropped, counted, reported once; the rest bit-identical",
             damagedVertices},
            {18, "Node with a quaternion of length 1.001", "normalised: to 1e-9 of unit length", longRotation},
            {20, "glTF without triangles, unindexed, of unknown extensions, damaged", "a picture or a clear error",
             filesOfManyKinds},
            {36, "Reflectivity above 1 or negative", "refused", reflectivityBounds}};
}

}  // namespace insonify::study
