#pragma once
#include "components/dataset/Sweep.hpp"

namespace insonify::dataset {

/** Returns the sweep with files for its scenes that have a recipe. The component library worlds makes a scene once per
 *  recipe, seed and generator. Scenes are kept in insonify/scenes of the user's cache. Throws types::ConfigError for a
 *  wrong recipe, or if the library is absent. */
Sweep withMadeScenes(Sweep sweep);

/** Returns a text that identifies the origin of the scenes with a recipe, for the hash of a data set; empty if there
 *  are none. */
std::string originsOf(const Sweep& sweep);

}  // namespace insonify::dataset
