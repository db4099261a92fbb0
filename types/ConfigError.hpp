#pragma once
#include <stdexcept>
#include <string>
#include <utility>

#include "types/Diagnostic.hpp"

namespace insonify::types {

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
