#pragma once
#include <string>

namespace insonify::deployer {

/** Prints what is in a scene, as `insonify scene` does; the exit code. Throws types::ConfigError for a file that cannot
 *  be read. */
int showScene(const std::string& file, bool json);

/** Whether a name is that of a scene: .gltf, .glb, .world, .sdf or .urdf. */
bool isSceneName(const std::string& name);

}  // namespace insonify::deployer
