#pragma once
#include <string>

#include "components/deployer/Json.hpp"

namespace insonify::deployer {

/** A scene file as a sonar will meet it, in the world's axes: {file, axes, bounds: {min, max, size, centre} [m] or
 *  null, triangles, materials: [{name, source: file or default, lambert_db [dB], reflection, roughness_slope or null,
 *  sediment or null, measured_angles, reflectivity, normal_map, triangles, area_m2}], objects: [{name, triangles,
 *  bounds}], nodes: [names that a connection may move], not_understood: [], warnings: []}. Throws types::ConfigError
 *  for a file that cannot be read. */
Json sceneReport(const std::string& file);

/** Prints it; the exit code. */
int showScene(const std::string& file, bool json);

/** Whether a name is that of a scene: .gltf, .glb, .world or .sdf. */
bool isSceneName(const std::string& name);

}  // namespace insonify::deployer
