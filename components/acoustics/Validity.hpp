#pragma once
#include <initializer_list>
#include <string>

namespace insonify::acoustics {

/** An input of a formula and the range for which the formula was made, ends included; all in `unit`. */
struct Limit {
    const char* unit;
    double value, min, max;
};

/** Returns the values outside their ranges, such as "1500 kHz (0.2 to 1000), 5 psu (30 to 35)"; empty when all are
 *  inside. */
std::string outside(std::initializer_list<Limit> limits);

}  // namespace insonify::acoustics
