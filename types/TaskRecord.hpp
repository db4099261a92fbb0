#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <variant>

namespace insonify::types {

/** What is known of one property besides its value. */
struct PropertyInfo {
    std::string name;  ///< Dotted below blocks; "[]" for an element of a list, "<name>" for one of a map.
    std::string type;  ///< "double", "rayleigh|gaussian", "block, optional"...
    std::string unit;
    std::string default_value;  ///< Empty: absent.
    double min = 0, max = 0;    ///< Inclusive; infinite when unbounded.
    std::string doc;
};

/** The value of a task's property as a log holds it; blocks and lists are text, in flow YAML. */
using PropertyValue = std::variant<bool, int64_t, double, std::string>;

/** What a log tells of a task besides its samples. */
struct TaskRecord {
    std::string name, type;
    std::map<std::string, PropertyValue> properties;  ///< Those that are present.
    std::string plan;                                 ///< In flow YAML; empty: it has none, or not yet.
};

}  // namespace insonify::types
