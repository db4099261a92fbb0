#pragma once
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace insonify::types {

/** One thing that is wrong with a configuration or a file. A struct that judges its own fields fills in `path`, below
 *  itself ("tvg.max_db"), and `message`; who reads the file adds the place. */
struct Diagnostic {
    std::string path;     ///< What it concerns: "tasks.sonar.properties.range", "meshes[2].primitives[0]".
    std::string message;  ///< What it is, and what it may be.
    std::string file = {};
    int line = 0, column = 0;  ///< From 1; 0: the place is unknown.

    /** `file:line:column: path: message`, without the parts that are not known. */
    std::string text() const;
};
using Diagnostics = std::vector<Diagnostic>;

/** Wrong usage, file or configuration: the program answers with exit code 2. Carries every diagnostic that was found.
 */
class ConfigError : public std::runtime_error {
public:
    explicit ConfigError(Diagnostics diagnostics);
    /** One diagnostic of which only the file (may be empty) and the object in it are known. */
    ConfigError(std::string file, std::string path, std::string message);
    const Diagnostics& diagnostics() const { return diagnostics_; }

private:
    Diagnostics diagnostics_;
};

}  // namespace insonify::types
