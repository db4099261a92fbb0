#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "components/dataset/Instances.hpp"
#include "components/dataset/Samples.hpp"
#include "components/scene/Scene.hpp"

namespace insonify::dataset {

/** What a sweep takes of a scene: the nodes that it places, where the file has them, what they keep off, and what they
 *  stand on. Throws types::ConfigError where the node is absent on which its objects stand. */
SceneParts partsOf(const Sweep& sweep, const scene::Scene& scene);

/** The names of each object of a scene, and of the nodes above it. */
std::vector<Lineage> lineagesOf(const scene::Scene& scene);

/** SHA-256 of all triangles of a scene, where its objects are, and of what material. */
std::string digestOf(const types::Geometry& geometry);

}  // namespace insonify::dataset
