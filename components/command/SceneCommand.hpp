#pragma once
#include <optional>
#include <string>

#include "components/scene/Drawings.hpp"
#include "components/scene/Placement.hpp"

namespace insonify::command {

/** Prints the contents of a scene, as `insonify scene` does, and returns the exit code. Throws types::ConfigError for a
 *  file that cannot be read.
 *  @param rules what is omitted of it
 *  @param placement where the scene is placed, as `placement` of scene::SceneTask
 *  @param frequency_khz at which thin walls reflect and pass sound; none: their resonances are printed [kHz] */
int showScene(const std::string& file, bool json, const scene::OmitRules& rules = {},
              std::optional<double> frequency_khz = {}, const scene::Placement& placement = {});

}  // namespace insonify::command
