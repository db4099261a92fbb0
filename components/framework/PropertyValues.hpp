#pragma once
// Described structs as text in flow YAML (JSON where all numbers are finite), and properties as values for the log.
#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "components/framework/PropertyList.hpp"
#include "types/TaskRecord.hpp"

namespace insonify::framework {

/** Whether there is nothing to write: an optional that is absent, a block that has moved. */
template <class T>
bool isAbsent(const T& value) {
    if constexpr (Optional<T>)
        return !value || isAbsent(*value);
    else
        return std::same_as<T, types::MovedTo>;
}

template <class T>
void emit(YAML::Emitter& out, const T& value) {
    if constexpr (std::same_as<T, bool> || std::same_as<T, YAML::Node>)
        out << value;
    else if constexpr (Number<T>)
        out << configText(value);
    else if constexpr (std::same_as<T, glm::dvec3>)
        out << YAML::BeginSeq << configText(value.x) << configText(value.y) << configText(value.z) << YAML::EndSeq;
    else if constexpr (std::same_as<T, std::string> || types::NamedEnum<T>)
        out << YAML::DoubleQuoted << configText(value);
    else if constexpr (Optional<T>)
        emit(out, *value);
    else if constexpr (Sequence<T>) {
        out << YAML::BeginSeq;
        for (const auto& element : value) emit(out, element);
        out << YAML::EndSeq;
    } else if constexpr (NamedMap<T>) {
        out << YAML::BeginMap;
        for (const auto& [key, element] : value) {
            out << YAML::Key << YAML::DoubleQuoted << key << YAML::Value;
            emit(out, element);
        }
        out << YAML::EndMap;
    } else {
        out << YAML::BeginMap;
        FieldVisitor visitor{[&](const types::Field& field, const auto& member) {
            if (isAbsent(member)) return;
            out << YAML::Key << YAML::DoubleQuoted << field.name << YAML::Value;
            emit(out, member);
        }};
        T::describe(value, visitor);
        out << YAML::EndMap;
    }
}

/** A value in flow YAML on one line, which ConfigReader reads back to the same value. */
template <class T>
std::string flowYaml(const T& value) {
    YAML::Emitter out;
    out.SetMapFormat(YAML::Flow);
    out.SetSeqFormat(YAML::Flow);
    emit(out, value);
    std::string text = out.c_str();
    std::replace(text.begin(), text.end(), '\n', ' ');  // flow breaks long lines
    return text;
}

/** A property as a log holds it: numbers, truth values and texts as such, all else in flow YAML. */
template <class T>
types::PropertyValue propertyValue(const T& value) {
    if constexpr (Optional<T>)
        return propertyValue(*value);
    else if constexpr (std::same_as<T, bool> || std::same_as<T, std::string>)
        return value;
    else if constexpr (std::floating_point<T>)
        return static_cast<double>(value);
    else if constexpr (std::integral<T>)
        return static_cast<int64_t>(value);
    else if constexpr (types::NamedEnum<T>)
        return configText(value);
    else
        return flowYaml(value);
}

/** The properties that are present, by name. */
template <types::Described Config>
std::map<std::string, types::PropertyValue> propertyValues(const Config& config) {
    std::map<std::string, types::PropertyValue> values;
    FieldVisitor visitor{[&](const types::Field& field, const auto& member) {
        if (!isAbsent(member)) values.emplace(field.name, propertyValue(member));
    }};
    Config::describe(config, visitor);
    return values;
}

}  // namespace insonify::framework
