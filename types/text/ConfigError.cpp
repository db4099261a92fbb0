#include "types/text/ConfigError.hpp"

#include <cerrno>
#include <new>
#include <string_view>
#include <system_error>

namespace insonify::types {
namespace {

std::string joined(const Diagnostics& diagnostics) {
    std::string text;
    for (const Diagnostic& d : diagnostics) text += (text.empty() ? "" : "\n") + d.text();
    return text;
}

/** Returns whether a text is from the standard library. Such texts begin with the function that throws: "stoi",
 *  "map::at", "basic_string::substr: __pos (which is 9) > ...". */
bool isOfStandardLibrary(std::string_view text) {
    const std::string_view first = text.substr(0, text.find_first_of(" :"));
    const std::string_view rest = text.substr(first.size());
    const bool is_conversion = rest.empty() && first.starts_with("sto") && first.size() <= 6;
    const bool is_container =
        rest.starts_with("::") && (first == "std" || first == "vector" || first == "deque" || first == "array" ||
                                   first == "bitset" || first == "optional" || first.ends_with("map") ||
                                   first.ends_with("Map_base") || first.starts_with("basic_string"));
    return is_conversion || is_container || text.starts_with("cannot create std::");
}

}  // namespace

std::string Diagnostic::text() const {
    std::string place = file;
    if (line > 0) place += ":" + std::to_string(line);
    if (line > 0 && column > 0) place += ":" + std::to_string(column);
    std::string result = place;
    if (!path.empty()) result += (result.empty() ? "" : ": ") + path;
    return result + (result.empty() ? "" : ": ") + message;
}

ConfigError::ConfigError(Diagnostics diagnostics)
    : std::runtime_error(joined(diagnostics)), diagnostics_(std::move(diagnostics)) {}

ConfigError::ConfigError(std::string file, std::string path, std::string message)
    : ConfigError(Diagnostics{{std::move(path), std::move(message), std::move(file)}}) {}

std::string getReason(const std::exception& failure) {
    if (dynamic_cast<const std::bad_alloc*>(&failure)) return "out of memory";
    if (!isOfStandardLibrary(failure.what())) return failure.what();
    if (dynamic_cast<const std::length_error*>(&failure)) return "out of memory";
    return "a number, a count or an index in it is out of bounds";
}

std::string permissionReason(int error_number) {
    return error_number == EACCES ? ": " + std::generic_category().message(error_number) : "";
}

}  // namespace insonify::types
