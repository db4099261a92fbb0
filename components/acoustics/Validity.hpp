#pragma once
#include <initializer_list>
#include <string>

namespace insonify::acoustics {

/** What a formula was made for, ends included, and what it is asked for; both in `unit`. */
struct Limit {
    const char* unit;
    double value, min, max;
};

/** What lies outside, with its range: "1500 kHz (0.2 to 1000), 5 psu (30 to 35)"; empty when nothing does. */
std::string outside(std::initializer_list<Limit> limits);

}  // namespace insonify::acoustics
