#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace insonify::console {

using Json = nlohmann::ordered_json;

/** Parses JSON that others wrote; discarded if it is not JSON. Values are copied recursively, so a value nested deeper
 *  than `deepest`, which no valid text has, is omitted. */
template <class Value = Json>
Value readJson(std::string_view text, int deepest = 8) {
    const auto keep = [=](int depth, typename Value::parse_event_t, Value&) { return depth <= deepest; };
    return Value::parse(text, keep, false);
}

std::string text(const Json& json);  ///< Indented; invalid UTF-8 is replaced, NaN and infinities are null.
void print(const Json& json);        ///< To stdout.
/** Throws std::runtime_error when the file cannot be written. */
void write(const Json& json, const std::string& file);

}  // namespace insonify::console
