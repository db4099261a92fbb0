#pragma once
// Strict reading of YAML into described structs: every diagnostic is collected, with its place, none stops the reading.
#include <yaml-cpp/mark.h>

#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "components/framework/ValueType.hpp"
#include "types/ConfigError.hpp"

namespace insonify::framework {

/** Where a value was written that is not from the file at hand. */
struct Origin {
    std::string file;                           ///< Or an option of the command line, set_origin for one.
    std::string path;                           ///< Its path there.
    YAML::Mark mark = YAML::Mark::null_mark();  ///< Its place there.

    bool isOption() const { return file.starts_with("--"); }
};
using Origins = std::map<std::string, Origin>;  ///< By path; what lies below is from there as well.
inline constexpr const char* set_origin = "--set";

class ConfigReader {
public:
    /** Diagnostics name `file`, but for paths that have an origin of their own. Without a file diagnostics have no
     *  place. */
    explicit ConfigReader(std::string file, Origins origins = {})
        : file_(std::move(file)), origins_(std::move(origins)) {}

    const types::Diagnostics& diagnostics() const { return diagnostics_; }
    void report(const YAML::Node& node, const std::string& path, const std::string& message);
    /** From now on null stands for what is not there: it takes an optional out, and gives any other value its default;
     *  maps of names are merged as well. */
    void takeOutByNull() { null_takes_out_ = true; }
    bool nullTakesOut() const { return null_takes_out_; }
    /** Where diagnostics of nodes that do not exist are reported: the block that lacks them. */
    void setFallback(const YAML::Mark& mark) { fallback_ = mark; }

    /** Reads `node` into `value`; what the node does not name keeps its value. False when there was any diagnostic. */
    template <types::Described T>
    bool read(const YAML::Node& node, const std::string& path, T& value) {
        return readBlock(*this, node, path, blockOf<T>(), &value);
    }
    template <class T>
    bool readValue(const YAML::Node& node, const std::string& path, const types::Field& field, T& value) {
        return typeOf<T>().read(*this, node, path, field, &value);
    }
    /** Reads a value from a piece of YAML that stands alone: an argument, a `--set`. */
    template <class T>
    bool readText(const std::string& yaml, const std::string& path, T& value) {
        return readText(yaml, path, typeOf<T>(), &value);
    }
    bool readText(const std::string& yaml, const std::string& path, const ValueType& type, void* value);

    /** Diagnostics of a block, each at the node that its path leads to. */
    void report(const YAML::Node& block, const std::string& path, const types::Diagnostics& diagnostics);

    bool isMap(const YAML::Node& node, const std::string& path);  ///< A map or empty, keys unique; else a diagnostic.
    bool isSequence(const YAML::Node& node, const std::string& path);  ///< Else a diagnostic.
    /** A diagnostic for each key that is not among `known`, with the nearest known one. */
    void refuseUnknown(const YAML::Node& map, const std::string& path, const std::vector<std::string>& known);

    // Scalars; each false with a diagnostic.
    bool number(const YAML::Node& node, const std::string& path, const types::Field& field, double& value);
    bool whole(const YAML::Node& node, const std::string& path, const types::Field& field, int64_t lowest,
               uint64_t highest, bool& negative, uint64_t& magnitude);
    bool oneOf(const YAML::Node& node, const std::string& path, const std::string_view* names, size_t count,
               size_t& index);
    bool text(const YAML::Node& node, const std::string& path, std::string& value);
    bool boolean(const YAML::Node& node, const std::string& path, bool& value);
    bool vector3(const YAML::Node& node, const std::string& path, const types::Field& field, glm::dvec3& value);

private:
    bool null_takes_out_ = false;
    std::string file_;
    Origins origins_;
    types::Diagnostics diagnostics_;
    YAML::Mark fallback_ = YAML::Mark::null_mark();
};

/** "did you mean range? known: range, model": for a name that is not known. */
std::string suggestion(std::string_view wrong, const std::vector<std::string>& known);

/** Names of what has a name: ports, operations. */
template <class Named>
std::vector<std::string> namesOf(const std::vector<Named*>& all) {
    std::vector<std::string> names;
    for (const Named* one : all) names.push_back(one->name());
    return names;
}

/** The value of `key` in a map, an undefined node if there is none (YAML::Node's operator[] of a const node, but for
 *  maps with keys that are not scalars as well). */
YAML::Node child(const YAML::Node& map, std::string_view key);

inline std::string below(const std::string& path, const std::string& name) {
    return path.empty() ? name : path + "." + name;
}

}  // namespace insonify::framework
