#pragma once
#include <string>

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

}  // namespace insonify::types
