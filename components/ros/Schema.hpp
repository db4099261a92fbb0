#pragma once
// What follows from a message's description: its definition as text, in MCAP's schema encoding "ros2msg", and the hash
// of its type.
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "components/ros/Cdr.hpp"
#include "types/text/Sha256.hpp"

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
    else if constexpr (BoundedSequence<T>)
        return fieldType<typename T::value_type>() + "[<=" + std::to_string(T::most) + "]";
    else if constexpr (Sequence<T>)
        return fieldType<typename T::value_type>() + "[]";
    else if constexpr (Array<T>)
        return fieldType<typename T::value_type>() + "[" + std::to_string(std::tuple_size_v<T>) + "]";
    else if constexpr (std::is_same_v<T, std::string>)
        return "string";
    else if constexpr (TruthValue<T>)
        return "bool";
    else if constexpr (std::is_same_v<T, std::byte>)
        return "byte";
    else if constexpr (std::is_floating_point_v<T>)
        return sizeof(T) == 8 ? "float64" : "float32";
    else
        return (std::is_signed_v<T> ? "int" : "uint") + std::to_string(8 * sizeof(T));
}

/** Returns the lines of one message: its constants, then its fields. */
template <Message T>
std::string describeDefinition() {
    std::string text;
    if constexpr (requires { T::constants; }) text = T::constants;
    T value{};
    auto line = [&]<class F>(const types::Field& field, F&) { text += fieldType<F>() + " " + field.name + "\n"; };
    T::describe(value, line);
    return text;
}

/** Returns the text of a `.msg` file: the summary, and the fields with units and meanings. */
template <Message T>
std::string getFile() {
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
    void addParts() {
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
            addParts<T>();
        else if (add(T::type_name, describeDefinition<T>()))
            addParts<T>();
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

/** Describes types as in ROS 2's RIHS01 (REP 2016): JSON of the fields, with the numbers of
 *  type_description_interfaces/msg/FieldType. */
class TypeDescription {
public:
    /** Returns the JSON of a message and, by name, of all messages within it. */
    template <Message T>
    static std::string json() {
        TypeDescription all;
        const std::string whole = all.typeJson<T>();
        std::string parts;
        for (const auto& [name, text] : all.parts_) parts += (parts.empty() ? "" : ", ") + text;
        return R"({"type_description": )" + whole + R"(, "referenced_type_descriptions": [)" + parts + "]}";
    }

private:
    template <Message T>
    std::string typeJson() {
        std::string fields;
        T value{};
        auto add = [&]<class F>(const types::Field& field, F&) {
            fields += (fields.empty() ? "" : ", ") + (R"({"name": ")" + std::string(field.name) + R"(", "type": )") +
                      fieldJson<F>() + "}";
        };
        T::describe(value, add);
        return R"({"type_name": ")" + std::string(T::type_name) + R"(", "fields": [)" + fields + "]}";
    }
    template <class F>
    std::string fieldJson() {
        if constexpr (BoundedSequence<F>)
            return fieldJson<typename F::value_type>(96, F::most);
        else if constexpr (Sequence<F>)
            return fieldJson<typename F::value_type>(144, 0);
        else if constexpr (Array<F>)
            return fieldJson<typename F::value_type>(48, std::tuple_size_v<F>);
        else
            return fieldJson<F>(0, 0);
    }
    /** @param many added to the type's number for arrays (48), bounded (96) and other sequences (144) */
    template <class Item>
    std::string fieldJson(int many, size_t capacity) {
        std::string name;
        if constexpr (Message<Item>) {
            name = Item::type_name;
            if (!parts_.contains(name)) {
                parts_[name];
                parts_[name] = typeJson<Item>();
            }
        }
        return R"({"type_id": )" + std::to_string(many + number<Item>()) + R"(, "capacity": )" +
               std::to_string(capacity) + R"(, "string_capacity": 0, "nested_type_name": ")" + name + "\"}";
    }
    template <class Item>
    static constexpr int number() {
        if constexpr (Message<Item>)
            return 1;
        else if constexpr (std::is_same_v<Item, std::string>)
            return 17;
        else if constexpr (std::is_same_v<Item, std::byte>)
            return 16;
        else if constexpr (TruthValue<Item>)
            return 15;
        else if constexpr (std::is_floating_point_v<Item>)
            return sizeof(Item) == 8 ? 11 : 10;
        else
            return 2 * std::bit_width(sizeof(Item)) + (std::is_signed_v<Item> ? 0 : 1);
    }

    std::map<std::string, std::string> parts_;
};

/** Returns the hash of a message's type, as ROS 2 announces it to other nodes: "RIHS01_" and 64 hexadecimal digits. */
template <Message T>
std::string typeHash() {
    return "RIHS01_" + types::sha256(TypeDescription::json<T>());
}

/** Returns the whole schema of a message: its definition and those of all nested messages. */
template <Message T>
std::string describeSchema() {
    Definitions parts;
    parts.addParts<T>();
    return describeDefinition<T>() + parts.text();
}

}  // namespace insonify::ros
