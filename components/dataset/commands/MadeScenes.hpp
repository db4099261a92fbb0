#pragma once
#include "components/dataset/Sweep.hpp"

namespace insonify::dataset {

/** The sweep with files for its scenes that have a recipe. A scene is made once for each recipe, seed and generator, by
 * the component library worlds, and is kept in insonify/scenes of the user's cache. Throws types::ConfigError for a
 * wrong recipe, or where the library is absent. */
Sweep withMadeScenes(Sweep sweep);

/** What the scenes with a recipe are made from, for the hash of a data set; empty where there are none. */
std::string originsOf(const Sweep& sweep);

}  // namespace insonify::dataset
