#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <variant>

namespace insonify::types {

/** The description of a property: everything except its value. */
struct PropertyInfo {
    std::string name;  ///< Dotted below blocks; "[]" for an element of a list, "<name>" for an element of a map.
    std::string type;  ///< "double", "rayleigh|gaussian", "block, optional"...
    std::string unit;
    std::string default_value;  ///< Empty: absent.
    double min = 0, max = 0;    ///< Inclusive; infinite when unbounded.
    std::string doc;
};

/** The value of a task's property in a log; blocks and lists are text, in flow YAML. */
using PropertyValue = std::variant<bool, int64_t, double, std::string>;

/** The record of a task in a log, in addition to its samples. */
struct TaskRecord {
    std::string name, type;
    std::map<std::string, PropertyValue> properties;  ///< Properties that are present.
    std::string plan;                                 ///< In flow YAML; empty: no plan, or not yet.
};

}  // namespace insonify::types
