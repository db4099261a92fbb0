#pragma once
#include <string>

#include "components/scene/Drawings.hpp"

namespace insonify::command {

/** Prints the contents of a scene, as `insonify scene` does, and returns the exit code. Throws types::ConfigError for a
 *  file that cannot be read.
 *  @param rules what is omitted of it */
int showScene(const std::string& file, bool json, const scene::OmitRules& rules = {});

}  // namespace insonify::command
