#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "types/ConfigError.hpp"
#include "types/Plan.hpp"

namespace insonify::deployer {

using Json = nlohmann::ordered_json;

Json toJson(const types::Diagnostic& diagnostic);
Json toJson(const std::vector<types::Omission>& omitted);
/** One line on the samples that a sonar takes. */
std::string qualityText(const types::Plan& plan);

/** `{features, passes, omitted, quality: {rows, columns_per_beam, slabs, predicted_error}, device, notices}`; an error
 * that is not predicted is null. */
Json toJson(const types::Plan& plan);

std::string text(const Json& json);  ///< Indented; text that is no UTF-8 is mended, NaN and infinities are null.
void print(const Json& json);        ///< To stdout.
/** Throws std::runtime_error when the file cannot be written. */
void write(const Json& json, const std::string& file);

}  // namespace insonify::deployer
