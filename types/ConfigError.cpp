#include "types/ConfigError.hpp"

namespace insonify::types {
namespace {

std::string joined(const std::vector<Diagnostic>& diagnostics) {
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

ConfigError::ConfigError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(joined(diagnostics)), diagnostics_(std::move(diagnostics)) {}

ConfigError::ConfigError(std::string file, std::string path, std::string message)
    : ConfigError(std::vector<Diagnostic>{{std::move(file), 0, 0, std::move(path), std::move(message)}}) {}

}  // namespace insonify::types
