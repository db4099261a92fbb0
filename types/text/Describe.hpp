#pragma once
// Descriptions of structs. YAML, logs, exports and help all use the description of a struct, which is written once.
//
//     struct Sample {
//         double range = 0;
//         static void describe(auto& self, auto& visit) {
//             visit({"range", "m", "slant range", 0, 500}, self.range);
//         }
//     };
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "types/text/ConfigError.hpp"

namespace insonify::types {

/** One field: its name in files, SI unit ("1" for a pure number, "" for text and blocks), meaning, inclusive bounds. */
struct Field {
    const char* name;
    const char* unit = "1";
    const char* doc = "";
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
};

/** Visitor that accepts every field, for the concept Described: structs with a describe() as above. */
struct AnyVisitor {
    template <class T>
    void operator()(const Field&, T&) {}
};
template <class T>
concept Described = requires(T& value, AnyVisitor& visit) {
    T::describe(value, visit);
};

/** Names of an enum whose values are 0, 1, 2...: specialise with `static constexpr std::string_view names[] = {...}`.
 */
template <class E>
struct EnumNames;
template <class E>
concept NamedEnum = requires {
    EnumNames<E>::names;
};

/** Rock's name and symbols of an enum that samples contain: specialise with `name` and `symbols[]`. */
struct EnumSymbol {
    const char* symbol;
    int32_t value;
};
template <class E>
struct EnumTable;

/** A described struct that validates its fields together: `void check(types::Diagnostics&) const`. */
template <class T>
concept Checked = requires(const T& value, Diagnostics& diagnostics) {
    value.check(diagnostics);
};

}  // namespace insonify::types
