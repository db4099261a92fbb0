#pragma once
// Strict reading of YAML into described structs: every diagnostic is collected, with its place, none stops the reading.
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <concepts>
#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "components/framework/YamlText.hpp"
#include "types/ConfigError.hpp"
#include "types/Describe.hpp"

namespace insonify::framework {

template <class T>
concept Number = std::integral<T> || std::floating_point<T>;

/** Where a value was written that is not from the file at hand. */
struct Origin {
    std::string file;                           ///< set_origin: nowhere, it was given with `--set`.
    std::string path;                           ///< Its path there.
    YAML::Mark mark = YAML::Mark::null_mark();  ///< Its place there.
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
    /** Where diagnostics of nodes that do not exist are reported: the block that lacks them. */
    void setFallback(const YAML::Mark& mark) { fallback_ = mark; }

    /** Reads `node` into `value`; what the node does not name keeps its value. False when there was any diagnostic. */
    template <types::Described T>
    bool read(const YAML::Node& node, const std::string& path, T& value);

    /** Diagnostics of a block, each at the node that its path leads to. */
    void report(const YAML::Node& block, const std::string& path, const types::Diagnostics& diagnostics);

    bool isMap(const YAML::Node& node, const std::string& path);  ///< A map or empty, keys unique; else a diagnostic.
    bool isSequence(const YAML::Node& node, const std::string& path);  ///< Else a diagnostic.
    /** A diagnostic for each key that is not among `known`, with the nearest known one. */
    void refuseUnknown(const YAML::Node& map, const std::string& path, const std::vector<std::string>& known);
    bool number(const YAML::Node& node, const std::string& path, const types::Field& field, double& value);

    template <class T>
    bool readValue(const YAML::Node& node, const std::string& path, const types::Field& field, T& value);
    /** Reads a value from a piece of YAML that stands alone: an argument, a `--set`. */
    template <class T>
    bool readText(const std::string& yaml, const std::string& path, T& value);

private:
    bool whole(const YAML::Node& node, const std::string& path, const types::Field& field, int64_t lowest,
               uint64_t highest, bool& negative, uint64_t& magnitude);
    bool oneOf(const YAML::Node& node, const std::string& path, const std::string_view* names, size_t count,
               size_t& index);
    bool text(const YAML::Node& node, const std::string& path, std::string& value);
    bool boolean(const YAML::Node& node, const std::string& path, bool& value);
    bool vector3(const YAML::Node& node, const std::string& path, const types::Field& field, glm::dvec3& value);
    template <Number T>
    bool readNumber(const YAML::Node& node, const std::string& path, const types::Field& field, T& value);
    template <class T>
    bool readSequence(const YAML::Node& node, const std::string& path, const types::Field& field, T& values);
    template <class T>
    bool readMap(const YAML::Node& node, const std::string& path, const types::Field& field, T& values);

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

// -- templates --------------------------------------------------------------------------------------------------------

template <class T>
struct Inner {
    using type = void;
};
template <class T>
struct Inner<std::vector<T>> {
    using type = T;
    static constexpr bool sequence = true;
};
template <class T>
struct Inner<std::optional<T>> {
    using type = T;
    static constexpr bool optional = true;
};
template <class T>
struct Inner<std::map<std::string, T>> {
    using type = T;
    static constexpr bool map = true;
};
template <class T>
concept Sequence = requires {
    Inner<T>::sequence;
};
template <class T>
concept Optional = requires {
    Inner<T>::optional;
};
template <class T>
concept NamedMap = requires {
    Inner<T>::map;
};

/** Calls `visit(field, value)` for each field, and knows their names. */
template <class Visit>
struct FieldVisitor {
    Visit visit;
    template <class T>
    void operator()(const types::Field& field, T& value) {
        visit(field, value);
    }
};
template <class Visit>
FieldVisitor(Visit) -> FieldVisitor<Visit>;

inline std::string below(const std::string& path, const std::string& name) {
    return path.empty() ? name : path + "." + name;
}

/** Gives a member of `whole` the value that it has in a fresh one. */
template <types::Described T, class Member>
void giveDefault(const T&, const types::Field& field, Member& member) {
    static const T fresh{};
    FieldVisitor visitor{[&](const types::Field& other, const auto& value) {
        if constexpr (std::same_as<std::remove_cvref_t<decltype(value)>, Member>)
            if (std::string_view(other.name) == field.name) member = value;
    }};
    T::describe(fresh, visitor);
}

template <types::Described T>
bool ConfigReader::read(const YAML::Node& node, const std::string& path, T& value) {
    const size_t before = diagnostics_.size();
    if (node.IsDefined() && !isMap(node, path)) return false;
    std::vector<std::string> known;
    FieldVisitor visitor{[&](const types::Field& field, auto& member) {
        known.push_back(field.name);
        const YAML::Node entry = child(node, field.name);
        if (entry.IsDefined() && entry.IsNull() && null_takes_out_)
            giveDefault(value, field, member);
        else if (entry.IsDefined())
            readValue(entry, below(path, field.name), field, member);
    }};
    T::describe(value, visitor);
    refuseUnknown(node, path, known);
    if constexpr (types::Checked<T>) {
        types::Diagnostics diagnostics;
        if (diagnostics_.size() == before) value.check(diagnostics);
        report(node, path, diagnostics);
    }
    return diagnostics_.size() == before;
}

template <class T>
bool ConfigReader::readValue(const YAML::Node& node, const std::string& path, const types::Field& field, T& value) {
    if constexpr (std::same_as<T, YAML::Node>) {
        value.reset(node);  // read later, by somebody who knows what it is
        return true;
    } else if constexpr (std::same_as<T, bool>) {
        return boolean(node, path, value);
    } else if constexpr (Number<T>) {
        return readNumber(node, path, field, value);
    } else if constexpr (std::same_as<T, std::string>) {
        return text(node, path, value);
    } else if constexpr (std::same_as<T, types::MovedTo>) {
        return report(node, path, field.doc), false;
    } else if constexpr (std::same_as<T, glm::dvec3>) {
        return vector3(node, path, field, value);
    } else if constexpr (types::NamedEnum<T>) {
        size_t index = 0;
        if (!oneOf(node, path, std::data(types::EnumNames<T>::names), std::size(types::EnumNames<T>::names), index))
            return false;
        value = static_cast<T>(index);
        return true;
    } else if constexpr (Optional<T>) {
        if (!value) value.emplace();
        return readValue(node, path, field, *value);
    } else if constexpr (Sequence<T>) {
        return readSequence(node, path, field, value);
    } else if constexpr (NamedMap<T>) {
        return readMap(node, path, field, value);
    } else {
        return read(node, path, value);
    }
}

template <class T>
bool ConfigReader::readSequence(const YAML::Node& node, const std::string& path, const types::Field& field, T& values) {
    if constexpr (types::Described<typename Inner<T>::type>)
        if (node.IsMap()) {  // a list of one
            values.assign(1, {});
            return readValue(node, path, field, values.front());
        }
    if (!isSequence(node, path)) return false;
    values.assign(node.size(), {});
    bool good = true;
    for (size_t i = 0; i < values.size(); ++i) {
        typename Inner<T>::type element{};
        good &= readValue(node[i], path + "[" + std::to_string(i) + "]", field, element);
        values[i] = std::move(element);
    }
    return good;
}

template <class T>
bool ConfigReader::readMap(const YAML::Node& node, const std::string& path, const types::Field& field, T& values) {
    if (!isMap(node, path)) return false;
    if (!null_takes_out_) values.clear();
    bool good = true;
    for (const auto& entry : node) {
        const std::string& key = entry.first.Scalar();
        if (null_takes_out_ && entry.second.IsNull())
            values.erase(key);
        else
            good &= readValue(entry.second, below(path, key), field, values[key]);
    }
    return good;
}

template <class T>
bool ConfigReader::readText(const std::string& yaml, const std::string& path, T& value) {
    try {
        return readValue(parseValue(yaml), path, types::Field{path.c_str()}, value);
    } catch (const types::ConfigError& error) {
        report(YAML::Node(YAML::NodeType::Undefined), path, error.diagnostics().front().message);
        return false;
    }
}

template <Number T>
bool ConfigReader::readNumber(const YAML::Node& node, const std::string& path, const types::Field& field, T& value) {
    if constexpr (std::integral<T>) {
        bool negative = false;
        uint64_t magnitude = 0;
        if (!whole(node, path, field, static_cast<int64_t>(std::numeric_limits<T>::min()),
                   static_cast<uint64_t>(std::numeric_limits<T>::max()), negative, magnitude))
            return false;
        value = static_cast<T>(negative ? ~magnitude + 1 : magnitude);
        return true;
    } else {
        double wide = 0;
        if (!number(node, path, field, wide)) return false;
        if (std::abs(wide) > static_cast<double>(std::numeric_limits<T>::max())) {
            report(node, path, "is " + node.Scalar() + "; is too large");
            return false;
        }
        value = static_cast<T>(wide);
        return true;
    }
}

}  // namespace insonify::framework
