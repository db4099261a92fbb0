#pragma once
#include <string>
#include <vector>

#include "components/scene/Animation.hpp"
#include "components/scene/GltfAccessor.hpp"
#include "components/scene/GltfFile.hpp"

namespace insonify::scene {

/** Animations of a file, and what of them is not played. */
struct GltfAnimations {
    std::vector<Animation> all;
    size_t other_paths = 0;    ///< Channels that animate neither a node nor weights, by an extension.
    size_t outside_scene = 0;  ///< Channels whose node is not in the scene.
    size_t doubled = 0;        ///< Channels that change what an earlier channel of the animation changes.
};

/** Reads the animations of a file. What is wrong with them is a types::ConfigError.
 *  @param node_in_scene  for each node of the file its index into Scene::nodes, -1 where the scene lacks it */
GltfAnimations readAnimations(const GltfFile& gltf, const GltfAccessors& accessors,
                              const std::vector<int>& node_in_scene);

}  // namespace insonify::scene
