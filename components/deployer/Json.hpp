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
/** Numbers, truth values, texts, lists and blocks of YAML as such; null for what is not there. */
Json toJson(const YAML::Node& node);
Json toJson(const std::vector<types::Omission>& omitted);
/** One line on the samples that a sonar takes. */
std::string qualityText(const types::Plan& plan);

/** `{features, passes, omitted, quality: {rows, columns_per_beam, slabs, predicted_error}, device, notices}`; an error
 *  that is not predicted is null. */
Json toJson(const types::Plan& plan);

}  // namespace insonify::deployer
