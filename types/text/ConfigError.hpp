#pragma once
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace insonify::types {

/** One error in a configuration or a file. A struct that checks its own fields fills in `message` and the `path` below
 *  itself ("tvg.max_db"); the reader of the file adds the place. */
struct Diagnostic {
    std::string path;     ///< Place in the data: "tasks.sonar.properties.range", "meshes[2].primitives[0]".
    std::string message;  ///< The value that is wrong, and the values that are allowed.
    std::string file = {};
    int line = 0, column = 0;  ///< From 1; 0: the place is unknown.
    /** What is wrong: a value; a key that nothing reads, which another task may have; a number that is not whole. */
    enum class Kind : uint8_t { Value, UnknownKey, NotWhole };
    Kind kind = Kind::Value;

    /** Returns `file:line:column: path: message`, without unknown parts. */
    std::string text() const;
};
using Diagnostics = std::vector<Diagnostic>;

/** An error in usage, a file or a configuration, with all diagnostics. The program exits with code 2. */
class ConfigError : public std::runtime_error {
public:
    explicit ConfigError(Diagnostics diagnostics);
    /** Makes an error of one diagnostic with a file, which may be empty, and a path, but without line and column. */
    ConfigError(std::string file, std::string path, std::string message);
    const Diagnostics& diagnostics() const { return diagnostics_; }

private:
    Diagnostics diagnostics_;
};

/** Returns the text of an exception for users. Texts that are only the name of a function of the standard library
 *  ("vector::_M_range_check", "stoi") and std::bad_alloc are replaced by a sentence. */
std::string getReason(const std::exception& failure);

/** Returns ": Permission denied" for this number of the system, to end a message on a file, and otherwise nothing:
 *  other reasons are clear from the message. */
std::string permissionReason(int error_number);

}  // namespace insonify::types
