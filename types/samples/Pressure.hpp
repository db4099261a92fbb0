#pragma once
#include <limits>

#include "types/Time.hpp"

namespace insonify::types {

/** Absolute pressure, field for field Rock's base::samples::Pressure. */
struct Pressure {
    static constexpr const char* type_name = "/base/samples/Pressure";

    float pascal = std::numeric_limits<float>::quiet_NaN();
    Time time;

    static void describe(auto& self, auto& visit) {
        visit({"pascal", "Pa", "of air and water; NaN: unknown"}, self.pascal);
        visit({"time", "us", "when the reading was true in the world"}, self.time);
    }
};

}  // namespace insonify::types
