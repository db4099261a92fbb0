#pragma once
#include <cmath>
#include <limits>
#include <numbers>

#include "types/text/Describe.hpp"

namespace insonify::types {

/** An angle in (-pi, pi]: Rock's base::Angle. NaN means unknown. */
struct Angle {
    static constexpr const char* type_name = "/base/Angle";
    double rad = std::numeric_limits<double>::quiet_NaN();

    /** Returns an angle normalised to (-pi, pi]; -pi becomes +pi. */
    static Angle fromRad(double rad) {
        const double turned = std::remainder(rad, 2 * std::numbers::pi);
        return {turned <= -std::numbers::pi ? std::numbers::pi : turned};
    }
    static Angle fromDeg(double deg) { return fromRad(deg * std::numbers::pi / 180); }
    double deg() const { return rad * 180 / std::numbers::pi; }
    bool isUnknown() const { return std::isnan(rad); }

    static void describe(auto& self, auto& visit) { visit({"rad", "rad", "angle, NaN when unknown"}, self.rad); }
};

constexpr double radians(double degrees) { return degrees * std::numbers::pi / 180; }
constexpr double degrees(double radians) { return radians * 180 / std::numbers::pi; }

}  // namespace insonify::types
