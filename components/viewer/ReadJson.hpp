#pragma once
#include <nlohmann/json.hpp>
#include <string_view>

namespace insonify::viewer {

/** Parses a client's message; discarded if it is not JSON. Values are copied recursively, so nesting deeper than any
 *  valid request is omitted. */
inline nlohmann::json readJson(std::string_view text) {
    constexpr int deepest = 8;
    const auto keep = [](int depth, nlohmann::json::parse_event_t, nlohmann::json&) { return depth <= deepest; };
    return nlohmann::json::parse(text, keep, false);
}

}  // namespace insonify::viewer
