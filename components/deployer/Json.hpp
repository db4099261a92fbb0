#pragma once
#include <string>
#include <vector>

#include "components/console/Json.hpp"
#include "components/framework/config/YamlText.hpp"
#include "types/samples/Plan.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::deployer {

using console::Json;
using console::print;
using console::text;
using console::write;

Json toJson(const types::Diagnostic& diagnostic);
/** Converts numbers, booleans, texts, lists and blocks of YAML; an undefined node becomes null. */
Json toJson(const YAML::Node& node);
Json toJson(const std::vector<types::Omission>& omitted);
/** Returns one line on the sonar's samples per ping. */
std::string qualityText(const types::Plan& plan);

/** Returns a plan as `insonify plan --json` prints it; an error without a prediction is null. */
Json toJson(const types::Plan& plan);

}  // namespace insonify::deployer
