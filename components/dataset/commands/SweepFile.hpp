#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "components/dataset/Annotate.hpp"
#include "components/dataset/Samples.hpp"
#include "components/dataset/Sweep.hpp"
#include "components/scene/Scene.hpp"

namespace insonify::dataset {

/** Returns the parts of a scene that a sweep needs: the nodes to place with their places in the file, the nodes to keep
 *  clear of, and the nodes to place on. Throws types::ConfigError if a node for objects to stand on is absent. */
SceneParts partsOf(const Sweep& sweep, const scene::Scene& scene);

/** Returns the names of each object of a scene, and of the nodes above it. */
std::vector<Lineage> lineages(const scene::Scene& scene);

/** Returns the SHA-256 of all triangles, objects' places and materials of a scene. */
std::string digestOf(const types::Geometry& geometry);

/** Reads the sweep of a data set. Its paths are resolved against its folder. Throws types::ConfigError with all
 *  diagnostics and their places. */
Sweep readSweep(const std::filesystem::path& file);

}  // namespace insonify::dataset
