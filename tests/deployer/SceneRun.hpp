#pragma once
// A scene made in code and run by the command: written as a glTF file, rendered by `insonify run` of a deployment with
// one fixed pose, and read by numpy from the output of `insonify log export`.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "tests/deployer/Wall.hpp"
#include "types/geometry/Geometry.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::deployer {

/** A glTF scene with its bytes in `scene.bin`. Vertices are written in glTF's axes: x, z, -y of the world's. */
class GltfWriter {
public:
    explicit GltfWriter(const types::Geometry& geometry) {
        for (const types::Material& material : geometry.materials)
            gltf_["materials"].push_back({{"extras", {{"acoustics", {{"lambert_db", material.lambert_db}}}}}});
        for (const types::Mesh& mesh : geometry.meshes) add(mesh);
        for (const types::Object& object : geometry.objects) {
            const glm::dvec4 at = object.world_from_object[3];
            gltf_["scenes"][0]["nodes"].push_back(gltf_["scenes"][0]["nodes"].size());
            gltf_["nodes"].push_back(
                {{"name", object.name}, {"mesh", object.mesh}, {"translation", {at.x, at.z, -at.y}}});
        }
        gltf_["buffers"] = {{{"byteLength", bytes_.size()}, {"uri", "scene.bin"}}};
    }
    void write(const TestFolder& folder) const {
        writeFile(folder / "scene.gltf", gltf_.dump());
        writeFile(folder / "scene.bin", bytes_);
    }

private:
    void add(const types::Mesh& mesh) {
        std::vector<glm::vec3> turned;
        glm::vec3 low(1e30f), high(-1e30f);
        for (const glm::vec3 p : mesh.positions) {
            turned.emplace_back(p.x, p.z, -p.y);
            low = glm::min(low, turned.back());
            high = glm::max(high, turned.back());
        }
        const size_t positions = accessor(toBytes(turned), turned.size(), 5126, "VEC3");
        gltf_["accessors"].back()["min"] = {low.x, low.y, low.z};
        gltf_["accessors"].back()["max"] = {high.x, high.y, high.z};
        const size_t indices = accessor(toBytes(mesh.indices), mesh.indices.size(), 5125, "SCALAR");
        const json primitive = {{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", 0}};
        gltf_["meshes"].push_back({{"primitives", {primitive}}});
    }
    size_t accessor(const std::string& bytes, size_t count, int component, const char* type) {
        const size_t index = gltf_["accessors"].size();
        gltf_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
        gltf_["accessors"].push_back(
            {{"bufferView", index}, {"componentType", component}, {"count", count}, {"type", type}});
        bytes_ += bytes;
        return index;
    }

    json gltf_ = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};
    std::string bytes_;
};

/** The pings of a stream, as numpy reads them from the npz file of `insonify log export`. */
inline std::vector<types::Sonar> exportedPings(const TestFolder& folder, const std::string& log,
                                               const std::string& stream) {
    const Outcome exported = callInsonify(folder, {"log", "export", log, "--stream", stream, "--to", "ping.npz"});
    if (exported.code != 0) throw std::runtime_error(exported.err);
    const Outcome read = python(folder, R"(
import numpy
ping = numpy.load('ping.npz')
print(*ping['bins'].shape)
flat = [ping[name].reshape(len(ping['time']), -1) for name in ('bin_duration', 'speed_of_sound', 'bearings', 'bins')]
numpy.hstack(flat).astype('<f8').tofile('ping.f8'))");
    if (read.code != 0) throw std::runtime_error("numpy cannot read the export: " + read.err);
    size_t count = 0;
    types::Sonar ping;
    std::istringstream(read.out) >> count >> ping.beam_count >> ping.bin_count;
    const std::string bytes = readFile(folder / "ping.f8");
    std::vector<double> numbers(bytes.size() / sizeof(double));
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
    const size_t stride = 2 + ping.beam_count * (1 + size_t{ping.bin_count});
    if (numbers.size() != count * stride) throw std::runtime_error("the export's arrays do not fit together");
    std::vector<types::Sonar> pings;
    for (const double* next = numbers.data(); pings.size() < count; next += stride) {
        ping.bin_duration = {std::llround(next[0] * 1e6)};
        ping.speed_of_sound = static_cast<float>(next[1]);
        const double* const bins = next + 2 + ping.beam_count;
        ping.bearings.clear();
        for (const double* bearing = next + 2; bearing != bins; ++bearing) ping.bearings.push_back({*bearing});
        ping.bins.assign(bins, next + stride);
        pings.push_back(ping);
    }
    return pings;
}

/** Returns the log of a sonar (its type and its properties in YAML) at the origin of a scene; `mount` turns it in the
 *  vehicle. */
inline std::vector<types::Sonar> loggedPings(const types::Geometry& scene, const std::string& type,
                                             const std::string& properties, const std::string& mount, size_t count) {
    const TestFolder folder;
    GltfWriter(scene).write(folder);
    writeFile(folder / "scene.yml", R"(schedule: lockstep
tasks:
  vehicle:
    type: pose::TrajectoryTask
    activity: {period: 0.1}
    properties: {waypoints: [{time: 0, position: [0, 0, 0], roll_deg: 0, pitch_deg: 0, yaw_deg: 0}]}
  scene: {type: scene::SceneTask, activity: {trigger: [pose]}, properties: {file: scene.gltf, mount: )" +
                                        mount + R"(}}
  sonar: {type: )" + type + R"(, activity: {trigger: [snapshot]}, properties: )" +
                                        properties + R"(}
  log: {type: logger::LoggerTask, properties: {file: x.0.log}}
connections:
  - {from: vehicle.pose, to: scene.pose}
  - {from: scene.snapshot, to: sonar.snapshot}
  - {from: sonar.ping, to: log.ping, policy: {type: buffer, size: 64}}
)");
    const Outcome run = callInsonify(folder, {"run", "scene.yml", "--pings", std::to_string(count), "--out", "out"});
    if (run.code != 0) throw std::runtime_error(run.err);
    return exportedPings(folder, "out/x.0.log", "sonar.ping");
}

/** Returns the only ping of a forward-looking sonar. */
inline types::Sonar loggedPing(const types::Geometry& scene, const std::string& properties,
                               const std::string& mount = "{yaw_deg: 0}") {
    return loggedPings(scene, "sonar::SonarTask", properties, mount, 1).at(0);
}

}  // namespace insonify::deployer
