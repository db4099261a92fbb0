#pragma once
#include <nlohmann/json.hpp>
#include <string_view>

namespace insonify::viewer {

/** What a client says; discarded where it is no JSON. Values are copied recursively, so what lies deeper than any
 *  request of ours is left out. */
inline nlohmann::json readJson(std::string_view text) {
    constexpr int deepest = 8;
    const auto keep = [](int depth, nlohmann::json::parse_event_t, nlohmann::json&) { return depth <= deepest; };
    return nlohmann::json::parse(text, keep, false);
}

}  // namespace insonify::viewer
