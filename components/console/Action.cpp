#include "components/console/Action.hpp"

#include <CLI/TypeTools.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace insonify::console {

std::string refuseUnlessWhole(const std::string& text) {
    uint64_t number = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    return error == std::errc() && stop == end ? "" : text + " is no whole number from 0 to 2^64 - 1";
}

std::string refuseUnlessPositive(const std::string& text) {
    double number = 0;
    if (CLI::detail::lexical_cast(text, number) && std::isfinite(number) && number > 0) return "";
    return text + " is no number above 0";
}

}  // namespace insonify::console
