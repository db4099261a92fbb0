#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "components/scene/Scene.hpp"
#include "components/scene/SceneConfig.hpp"

namespace insonify::scene {

/** A configured point target, with its place for each node that may carry it. */
struct PlacedTarget {
    /** A moving node at or above the target's node. */
    struct Carrier {
        int node = -1;        ///< Index into Scene::nodes.
        glm::dvec3 place{0};  ///< In the axes of the node's body, as in Part::body_from_object [m].
    };
    glm::dvec3 in_world{0};         ///< Place before any node has moved [m].
    double strength_db = 0;         ///< [dB re 1 m^2]
    std::vector<Carrier> carriers;  ///< Inner nodes before outer nodes.
    int node = -1;                  ///< The target's node, -1 for none.
    glm::dvec3 offset{0};           ///< Place in the axes of that node, as in the configuration [m].
};

/** Places targets in a scene whose nodes `moving` move. Adds errors to `diagnostics` at path
 *  `targets[0].attached_to`. */
std::vector<PlacedTarget> placeTargets(const Scene& scene, const std::vector<TargetConfig>& targets,
                                       const std::vector<int>& moving, types::Diagnostics& diagnostics);

}  // namespace insonify::scene
