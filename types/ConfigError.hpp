#pragma once
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace insonify::types {

/** One thing that is wrong in a file. Lines and columns count from 1; 0 means that the place is unknown. */
struct Diagnostic {
    std::string file;
    int line = 0;
    int column = 0;
    std::string path;     ///< What it concerns: "tasks.sonar.properties.range", "meshes[2].primitives[0]".
    std::string message;  ///< What it is, and what it may be.

    /** `file:line:column: path: message`, without the parts that are not known. */
    std::string text() const;
};

/** Wrong usage, file or configuration: the program answers with exit code 2. Carries every fault that was found. */
class ConfigError : public std::runtime_error {
public:
    explicit ConfigError(std::vector<Diagnostic> diagnostics);
    /** One fault of which only the file (may be empty) and the object in it are known. */
    ConfigError(std::string file, std::string path, std::string message);
    const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

private:
    std::vector<Diagnostic> diagnostics_;
};

}  // namespace insonify::types
