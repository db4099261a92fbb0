#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace insonify::command {

using Json = nlohmann::ordered_json;

std::string text(const Json& json);  ///< Indented; invalid UTF-8 is replaced, NaN and infinities are null.
void print(const Json& json);        ///< To stdout.
/** Throws std::runtime_error when the file cannot be written. */
void write(const Json& json, const std::string& file);

}  // namespace insonify::command
