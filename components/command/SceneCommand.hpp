#pragma once
#include <optional>
#include <string>

#include "components/scene/Drawings.hpp"

namespace insonify::command {

/** Prints the contents of a scene, as `insonify scene` does, and returns the exit code. Throws types::ConfigError for a
 *  file that cannot be read.
 *  @param rules what is omitted of it
 *  @param frequency_khz at which thin walls reflect and pass sound; none: their resonances are printed [kHz] */
int showScene(const std::string& file, bool json, const scene::OmitRules& rules = {},
              std::optional<double> frequency_khz = {});

}  // namespace insonify::command
