#pragma once
// A minimal deployment: a sonar 10 m in front of a wall, and a log.
#include <cstdint>
#include <string>
#include <vector>

#include "tests/deployer/Command.hpp"
#include "tests/support/Base64.hpp"

namespace insonify::deployer {

template <class T>
std::string toBytes(const std::vector<T>& values) {
    return test::toBytes(std::span(values));
}

/** A glTF file of one mesh; positions are x, y, z in glTF's own axes (y up). */
inline std::string makeGltf(const std::vector<float>& positions, const std::vector<uint16_t>& indices) {
    const std::string data = toBytes(positions) + toBytes(indices);
    const size_t split = positions.size() * sizeof(float);
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "wall"}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": )" +
           std::to_string(positions.size() / 3) + R"(, "type": "VEC3", "min": [-50, -50, -50], "max": [50, 50, 50]},
{"bufferView": 1, "componentType": 5123, "count": )" +
           std::to_string(indices.size()) + R"(, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": )" +
           std::to_string(split) + R"(}, {"buffer": 0, "byteOffset": )" + std::to_string(split) +
           R"(, "byteLength": )" + std::to_string(data.size() - split) + R"(}],
"buffers": [{"byteLength": )" +
           std::to_string(data.size()) + R"(, "uri": "data:application/octet-stream;base64,)" + test::base64(data) +
           R"("}]})";
}

/** 40 m x 40 m, square to the x axis at x = 10 m. */
inline std::string wallGltf() {
    return makeGltf({10, -20, 20, 10, -20, -20, 10, 20, -20, 10, 20, 20}, {0, 1, 2, 0, 2, 3});
}

inline const std::string wall_deployment = R"(schedule: lockstep
tasks:
  vehicle:
    type: pose::TrajectoryTask
    activity: {period: 0.1}
    properties:
      waypoints: [{time: 0, position: [0, 0, 0], roll_deg: 0, pitch_deg: 0, yaw_deg: 0}]
  scene:
    type: scene::SceneTask
    activity: {trigger: [pose]}
    properties: {file: wall.gltf}
  sonar:
    type: sonar::SonarTask
    activity: {trigger: [snapshot]}
    properties:
      range: 20
      beam_count: 16
      bin_count: 50
      field_of_view_deg: 60
      beam_height_deg: 10
      quality: {rows: 32, columns_per_beam: 2}
  noise:
    type: noise::NoiseTask
    activity: {trigger: [clean]}
    properties: {seed: 7, speckle: {law: rayleigh}}
  log:
    type: logger::LoggerTask
    properties: {file: wall.0.log}
connections:
  - {from: vehicle.pose, to: scene.pose}
  - {from: scene.snapshot, to: sonar.snapshot}
  - {from: sonar.ping, to: noise.clean}
  - {from: sonar.ping, to: log.clean, policy: {type: buffer, size: 64}}
  - {from: noise.noisy, to: log.noisy, policy: {type: buffer, size: 64}}
  - {from: vehicle.pose, to: log.pose, policy: {type: buffer, size: 64}}
)";

/** Returns `text` with the first `what` replaced; throws when there is none, so that a test cannot pass by mistake. */
inline std::string replaced(std::string text, const std::string& what, const std::string& with) {
    const size_t at = text.find(what);
    if (at == std::string::npos) throw std::runtime_error("not in the text: " + what);
    return text.replace(at, what.size(), with);
}

/** The same in realtime. A slow machine must look neither like a missing vehicle nor like a hanging hook. */
inline std::string realtimeWall() {
    const std::string text = replaced(wall_deployment, "schedule: lockstep", "schedule: realtime\nwatchdog: 1000000");
    return replaced(text, "{file: wall.gltf}", "{file: wall.gltf, pose_timeout: 60}");
}

/** A folder with wall.yml and wall.gltf. */
struct WallFolder : TestFolder {
    explicit WallFolder(const std::string& deployment = wall_deployment, const std::string& gltf = wallGltf()) {
        writeFile(*this / "wall.yml", deployment);
        writeFile(*this / "wall.gltf", gltf);
    }
    /** Runs `insonify run wall.yml --out out` with further arguments. */
    Outcome run(std::vector<std::string> more = {"--pings", "2"}) const {
        std::vector<std::string> arguments = {"run", "wall.yml", "--out", "out"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return callInsonify(*this, std::move(arguments));
    }
};

}  // namespace insonify::deployer
