#pragma once
// Properties as text, for `describe`.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "components/framework/ConfigReader.hpp"
#include "types/TaskRecord.hpp"

namespace insonify::framework {

using types::PropertyInfo;

template <class T>
std::string configTypeName() {
    if constexpr (std::same_as<T, bool>)
        return "bool";
    else if constexpr (std::floating_point<T>)
        return "double";
    else if constexpr (std::integral<T>)
        return std::is_signed_v<T> ? "integer" : "integer >= 0";
    else if constexpr (std::same_as<T, std::string>)
        return "text";
    else if constexpr (std::same_as<T, glm::dvec3>)
        return "[x, y, z]";
    else if constexpr (types::NamedEnum<T>)
        return fmt::format("{}", fmt::join(types::EnumNames<T>::names, "|"));
    else if constexpr (Optional<T>)
        return configTypeName<typename Inner<T>::type>() + ", optional";
    else if constexpr (Sequence<T>)
        return "list of " + configTypeName<typename Inner<T>::type>();
    else if constexpr (NamedMap<T>)
        return "map of " + configTypeName<typename Inner<T>::type>();
    else
        return "block";
}

template <class T>
std::string configText(const T& value) {
    if constexpr (Number<T> || std::same_as<T, std::string>)
        return fmt::format("{}", value);
    else if constexpr (std::same_as<T, glm::dvec3>)
        return fmt::format("[{}, {}, {}]", value.x, value.y, value.z);
    else if constexpr (types::NamedEnum<T>)
        return std::string(types::EnumNames<T>::names[static_cast<size_t>(value)]);
    else if constexpr (Optional<T>)
        return value ? configText(*value) : "";
    else if constexpr (Sequence<T>) {
        std::vector<std::string> texts;
        for (const auto& element : value) texts.push_back(configText(element));
        return fmt::format("[{}]", fmt::join(texts, ", "));
    } else
        return "";
}

template <types::Described T>
void listFields(const std::string& prefix, const T& defaults, std::vector<PropertyInfo>& list);

/** The fields of a block, of the block in an optional, list or map; nothing for plain values. */
template <class T>
void listInner(const std::string& name, const T& value, std::vector<PropertyInfo>& list) {
    if constexpr (Optional<T>)
        listInner(name, value ? *value : typename Inner<T>::type{}, list);
    else if constexpr (Sequence<T>)
        listInner(name + "[]", typename Inner<T>::type{}, list);
    else if constexpr (NamedMap<T>)
        listInner(name + ".<name>", typename Inner<T>::type{}, list);
    else if constexpr (types::Described<T>)
        listFields(name, value, list);
}

template <types::Described T>
void listFields(const std::string& prefix, const T& defaults, std::vector<PropertyInfo>& list) {
    FieldVisitor visitor{[&](const types::Field& field, const auto& member) {
        using Member = std::remove_cvref_t<decltype(member)>;
        if constexpr (!std::same_as<Member, std::optional<types::MovedTo>>) {
            const std::string name = below(prefix, field.name);
            list.push_back(
                {name, configTypeName<Member>(), field.unit, configText(member), field.min, field.max, field.doc});
            listInner(name, member, list);
        }
    }};
    T::describe(defaults, visitor);
}

template <types::Described Config>
std::vector<PropertyInfo> listProperties(const Config& defaults) {
    std::vector<PropertyInfo> list;
    listFields("", defaults, list);
    return list;
}

}  // namespace insonify::framework
