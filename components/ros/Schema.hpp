#pragma once
// The definition of a message as text, in MCAP's schema encoding "ros2msg", made from the message's description.
#include <algorithm>
#include <string>
#include <vector>

#include "components/ros/Cdr.hpp"

namespace insonify::ros {

/** Shortens "std_msgs/msg/Header" to "std_msgs/Header". */
inline std::string shortName(const std::string& type_name) {
    const size_t middle = type_name.find("/msg/");
    return type_name.substr(0, middle) + type_name.substr(middle + 4);
}

template <class T>
std::string fieldType() {
    if constexpr (Message<T>)
        return shortName(T::type_name);
    else if constexpr (Sequence<T>)
        return fieldType<typename T::value_type>() + "[]";
    else if constexpr (Array<T>)
        return fieldType<typename T::value_type>() + "[" + std::to_string(std::tuple_size_v<T>) + "]";
    else if constexpr (std::is_same_v<T, std::string>)
        return "string";
    else if constexpr (std::is_same_v<T, bool>)
        return "bool";
    else if constexpr (std::is_floating_point_v<T>)
        return sizeof(T) == 8 ? "float64" : "float32";
    else
        return (std::is_signed_v<T> ? "int" : "uint") + std::to_string(8 * sizeof(T));
}

/** Returns the lines of one message: its constants, then its fields. */
template <Message T>
std::string definitionOf() {
    std::string text;
    if constexpr (requires { T::constants; }) text = T::constants;
    T value{};
    auto line = [&]<class F>(const types::Field& field, F&) { text += fieldType<F>() + " " + field.name + "\n"; };
    T::describe(value, line);
    return text;
}

/** Returns the text of a `.msg` file: the summary, and the fields with units and meanings. */
template <Message T>
std::string fileOf() {
    std::string text = "# " + std::string(T::summary) + "\n# Made by ros_messages from components/ros.\n";
    T value{};
    auto line = [&]<class F>(const types::Field& field, F&) {
        const std::string name = field.unit, unit = name.empty() || name == "1" ? "" : "[" + name + "]";
        const std::string note = unit + (!unit.empty() && *field.doc ? " " : "") + field.doc;
        text += fieldType<F>() + " " + field.name + (note.empty() ? "" : "  # " + note) + "\n";
    };
    T::describe(value, line);
    return text;
}

/** Collects the definitions of nested messages, each once, in the order of first use. */
class Definitions {
public:
    template <class T>
    void addPartsOf() {
        if constexpr (Sequence<T> || Array<T>)
            addIfMessage<typename T::value_type>();
        else if constexpr (Message<T>) {
            T value{};
            auto add = [&]<class F>(const types::Field&, F&) { addIfMessage<F>(); };
            T::describe(value, add);
        }
    }
    /** Returns the definitions, each after a separator and a line `MSG: pkg/Type`. */
    const std::string& text() const { return text_; }

private:
    template <class T>
    void addIfMessage() {
        if constexpr (!Message<T>)
            addPartsOf<T>();
        else if (add(T::type_name, definitionOf<T>()))
            addPartsOf<T>();
    }
    bool add(const std::string& type_name, const std::string& definition) {
        if (std::ranges::count(known_, type_name)) return false;
        known_.push_back(type_name);
        text_ += std::string(80, '=') + "\nMSG: " + shortName(type_name) + "\n" + definition;
        return true;
    }

    std::vector<std::string> known_;
    std::string text_;
};

/** Returns the whole schema of a message: its definition and those of all nested messages. */
template <Message T>
std::string schemaOf() {
    Definitions parts;
    parts.addPartsOf<T>();
    return definitionOf<T>() + parts.text();
}

}  // namespace insonify::ros
