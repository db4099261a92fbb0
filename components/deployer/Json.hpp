#pragma once
#include <string>
#include <vector>

#include "components/command/Json.hpp"
#include "components/framework/YamlText.hpp"
#include "types/ConfigError.hpp"
#include "types/Plan.hpp"

namespace insonify::deployer {

using command::Json;
using command::print;
using command::text;
using command::write;

Json toJson(const types::Diagnostic& diagnostic);
/** Converts numbers, booleans, texts, lists and blocks of YAML; an undefined node becomes null. */
Json toJson(const YAML::Node& node);
Json toJson(const std::vector<types::Omission>& omitted);
/** Returns one line on the sonar's samples per ping. */
std::string qualityText(const types::Plan& plan);

/** Returns a plan as `insonify plan --json` prints it; an error without a prediction is null. */
Json toJson(const types::Plan& plan);

}  // namespace insonify::deployer
