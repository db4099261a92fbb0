#pragma once
// Strict reading of YAML into described structs. Reading continues after an error: every diagnostic is collected with
// its place.
#include <yaml-cpp/mark.h>

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/framework/config/ValueType.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::framework {

/** A unit as a factor (and, for temperatures, an offset) to SI units: powers of m, kg, s, K and rad. */
struct Unit {
    using Dimension = std::array<int, 5>;
    double scale = 1;
    double zero = 0;
    Dimension dimension{};
    friend bool operator==(const Unit&, const Unit&) = default;
};

/** Returns the unit of a property: "m", "m/s", "deg", "kHz", "degC", "1"...; none for levels (dB) and unknown units. */
std::optional<Unit> findUnit(std::string_view name);

/** A number with its unit, as in Rock's configuration files. */
struct Quantity {
    double number = 0;
    Unit unit;
    char rounding = 0;  ///< 'r', 'f', 'c': round, floor, ceil; 0: none.

    /** Parses "20.deg", "5.cm", "3.m.s^-1", "7.5.m.floor": a number, then units (m N deg s g Pa bar, rad K Hz) with
     *  prefixes (M k d c m mu u n p) and powers. Returns none for other forms. */
    static std::optional<Quantity> parse(std::string_view text);
    /** Returns the number in another unit; none when the dimensions differ. */
    std::optional<double> in(const Unit& other) const;
};

/** The origin of a value that is not written in the deployment file itself. */
struct Origin {
    std::string file;                           ///< Or an option of the command line, such as set_origin.
    std::string path;                           ///< The value's path in that file.
    YAML::Mark mark = YAML::Mark::null_mark();  ///< The value's place in that file.

    bool isOption() const { return file.starts_with("--"); }
};
using Origins = std::map<std::string, Origin>;  ///< By path; a path includes everything below it.
inline constexpr const char* set_origin = "--set";

class ConfigReader {
public:
    /** Diagnostics name `file`, except for paths with their own origin. If `file` is empty, diagnostics have no
     *  place. */
    explicit ConfigReader(std::string file, Origins origins = {})
        : file_(std::move(file)), origins_(std::move(origins)) {}

    const types::Diagnostics& diagnostics() const { return diagnostics_; }
    void report(const YAML::Node& node, const std::string& path, const std::string& message,
                types::Diagnostic::Kind kind = types::Diagnostic::Kind::Value);
    /** Makes null remove values: it empties an optional and resets any other value to its default. Maps of names are
     *  merged as well. */
    void removeByNull() { null_removes_ = true; }
    bool nullTakesOut() const { return null_removes_; }
    /** Sets the place for diagnostics of nodes that do not exist: the block that lacks them. */
    void setFallback(const YAML::Mark& mark) { fallback_ = mark; }

    /** Reads `node` into `value`; fields that the node does not name keep their values. Returns false when there was
     *  any diagnostic. */
    template <types::Described T>
    bool read(const YAML::Node& node, const std::string& path, T& value) {
        return readBlock(*this, node, path, getBlock<T>(), &value);
    }
    template <class T>
    bool readValue(const YAML::Node& node, const std::string& path, const types::Field& field, T& value) {
        return getType<T>().read(*this, node, path, field, &value);
    }
    /** Reads a value from a separate piece of YAML: an argument, a `--set`. */
    template <class T>
    bool readText(const std::string& yaml, const std::string& path, T& value) {
        return readText(yaml, path, getType<T>(), &value);
    }
    bool readText(const std::string& yaml, const std::string& path, const ValueType& type, void* value);

    /** Reports diagnostics of a block, each at the node of its path. */
    void report(const YAML::Node& block, const std::string& path, const types::Diagnostics& diagnostics);

    /** A map or empty, keys unique; else a diagnostic. @param example of the map; empty: none is shown */
    bool isMap(const YAML::Node& node, const std::string& path, const std::string& example = "");
    /** Else a diagnostic. @param form of the list, which follows "must be a list" */
    bool isSequence(const YAML::Node& node, const std::string& path, const std::string& form = "");
    /** Reports each key that is not among `known`, with the nearest known key. */
    void refuseUnknown(const YAML::Node& map, const std::string& path, const std::vector<std::string>& known);

    // Scalars; each false with a diagnostic.
    bool number(const YAML::Node& node, const std::string& path, const types::Field& field, double& value,
                const char* wanted = "must be a finite number");
    bool whole(const YAML::Node& node, const std::string& path, const types::Field& field, int64_t lowest,
               uint64_t highest, bool& negative, uint64_t& magnitude);
    bool oneOf(const YAML::Node& node, const std::string& path, const std::string_view* names, size_t count,
               size_t& index);
    bool text(const YAML::Node& node, const std::string& path, std::string& value);
    bool boolean(const YAML::Node& node, const std::string& path, bool& value);
    bool vector3(const YAML::Node& node, const std::string& path, const types::Field& field, glm::dvec3& value);

private:
    bool null_removes_ = false;
    std::string file_;
    Origins origins_;
    types::Diagnostics diagnostics_;
    YAML::Mark fallback_ = YAML::Mark::null_mark();
};

/** Returns the hint for an unknown name: "did you mean range? known: range, model". */
std::string suggestion(std::string_view wrong, const std::vector<std::string>& known);

/** Returns the names of ports or operations. */
template <class Named>
std::vector<std::string> getNames(const std::vector<Named*>& all) {
    std::vector<std::string> names;
    for (const Named* one : all) names.push_back(one->name());
    return names;
}

/** Returns the value of `key` in a map, or an undefined node if there is none. Unlike YAML::Node's operator[] of a
 *  const node, it accepts maps with keys that are not scalars. */
YAML::Node child(const YAML::Node& map, std::string_view key);

inline std::string below(const std::string& path, const std::string& name) {
    return path.empty() ? name : path + "." + name;
}

}  // namespace insonify::framework
