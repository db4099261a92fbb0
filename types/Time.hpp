#pragma once
#include <cmath>
#include <compare>
#include <cstdint>

#include "types/text/Describe.hpp"

namespace insonify::types {

/** A time in the (simulated) world, or a duration: Rock's base::Time. 0 is Rock's null: "no time". */
struct Time {
    static constexpr const char* type_name = "/base/Time";
    int64_t microseconds = 0;

    static Time fromSeconds(double seconds) { return {static_cast<int64_t>(std::llround(seconds * 1e6))}; }
    double seconds() const { return static_cast<double>(microseconds) * 1e-6; }
    bool isNull() const { return microseconds == 0; }

    friend auto operator<=>(const Time&, const Time&) = default;
    friend Time operator+(Time a, Time b) { return {a.microseconds + b.microseconds}; }
    friend Time operator-(Time a, Time b) { return {a.microseconds - b.microseconds}; }

    static void describe(auto& self, auto& visit) {
        visit({"microseconds", "us", "since the epoch, or a duration"}, self.microseconds);
    }
};

}  // namespace insonify::types
