#include "types/ConfigError.hpp"

namespace insonify::types {
namespace {

std::string joined(const Diagnostics& diagnostics) {
    std::string text;
    for (const Diagnostic& d : diagnostics) text += (text.empty() ? "" : "\n") + d.text();
    return text;
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

}  // namespace insonify::types
