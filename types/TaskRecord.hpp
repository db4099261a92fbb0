#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <variant>

namespace insonify::types {

/** The value of a task's property as a log holds it; blocks and lists are text, in flow YAML. */
using PropertyValue = std::variant<bool, int64_t, double, std::string>;

/** What a log tells of a task besides its samples. */
struct TaskRecord {
    std::string name, type;
    std::map<std::string, PropertyValue> properties;  ///< Those that are present.
    std::string plan;                                 ///< In flow YAML; empty: it has none, or not yet.
};

}  // namespace insonify::types
