#pragma once
#include <array>
#include <optional>
#include <string_view>

namespace insonify::framework {

/** A unit as a factor (and, for temperatures, an offset) to SI units: powers of m, kg, s, K and rad. */
struct Unit {
    using Dimension = std::array<int, 5>;
    double scale = 1;
    double zero = 0;
    Dimension dimension{};
    friend bool operator==(const Unit&, const Unit&) = default;
};

/** Returns the unit of a property: "m", "m/s", "deg", "kHz", "degC", "1"...; none for levels (dB) and unknown units. */
std::optional<Unit> unitOf(std::string_view name);

/** A number with its unit, as in Rock's configuration files. */
struct Quantity {
    double number = 0;
    Unit unit;
    char rounding = 0;  ///< 'r', 'f', 'c': round, floor, ceil; 0: none.

    /** Parses "20.deg", "5.cm", "3.m.s^-1", "7.5.m.floor": a number, then units (m N deg s g Pa bar, rad K Hz) with
     *  prefixes (M k d c m mu u n p) and powers. Returns none for other forms. */
    static std::optional<Quantity> parse(std::string_view text);
    /** Returns the number in another unit; none when the dimensions differ. */
    std::optional<double> in(const Unit& other) const;
};

}  // namespace insonify::framework
