#pragma once
#include <map>
#include <string>

#include "components/scene/Acoustics.hpp"
#include "components/scene/Scene.hpp"

namespace insonify::scene {

/** The geometry of `scene` with acoustic values replaced by name of a material, or of a node with all below it, which
 *  goes before the material. Nothing is copied when there is nothing to replace. A name that is neither is a diagnostic
 *  at path `materials.<name>`. */
types::GeometryPtr overrideMaterials(const Scene& scene, const std::map<std::string, Acoustics>& materials,
                                     types::Diagnostics& diagnostics);

}  // namespace insonify::scene
