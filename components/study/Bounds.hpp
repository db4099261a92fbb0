#pragma once
#include <cmath>
#include <concepts>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "types/Describe.hpp"

namespace insonify::study {

/** Gathers the numbers of a described struct that are outside the bounds of their fields, NaN among them. */
struct BoundsVisitor {
    types::Diagnostics diagnostics;

    template <class T>
    void operator()(const types::Field& field, const T& value) {
        if constexpr (std::floating_point<T> || std::integral<T>) {
            const auto number = static_cast<double>(value);
            if (!(number >= field.min && number <= field.max) || !std::isfinite(number))
                diagnostics.push_back({field.name, "is out of bounds"});
        } else if constexpr (types::Described<T>) {
            T::describe(value, *this);
            if constexpr (types::Checked<T>) value.check(diagnostics);
        }
    }
    template <class T>
    void operator()(const types::Field& field, const std::optional<T>& value) {
        if (value) (*this)(field, *value);
    }
    template <class T>
    void operator()(const types::Field& field, const std::vector<T>& values) {
        for (const T& value : values) (*this)(field, value);
    }
};

/** Why a configuration is refused before anything starts: its fields' bounds, then, as a reader of YAML does it only
 *  when those are kept, what its fields have to do with one another. */
template <types::Described T>
types::Diagnostics faultsOf(const T& config) {
    BoundsVisitor visitor;
    T::describe(config, visitor);
    if constexpr (types::Checked<T>)
        if (visitor.diagnostics.empty()) config.check(visitor.diagnostics);
    return visitor.diagnostics;
}

}  // namespace insonify::study
