#pragma once
#include <vector>

#include "components/scene/Animation.hpp"
#include "components/scene/GltfAccessor.hpp"
#include "components/scene/GltfFile.hpp"

namespace insonify::scene {

/** Animations of a file, with counts of omitted channels. */
struct GltfAnimations {
    std::vector<Animation> all;
    size_t other_paths = 0;    ///< Channels of extensions, which animate neither a node nor weights.
    size_t outside_scene = 0;  ///< Channels whose node is not in the scene.
    size_t doubled = 0;        ///< Channels that animate the same property as an earlier channel.
};

/** Reads the animations of a file. Throws types::ConfigError for wrong data.
 *  @param node_in_scene  for each node of the file its index into Scene::nodes, -1 if it is not in the scene */
GltfAnimations readAnimations(const GltfFile& gltf, const GltfAccessors& accessors,
                              const std::vector<int>& node_in_scene);

}  // namespace insonify::scene
