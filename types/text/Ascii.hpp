#pragma once
#include <string>

namespace insonify::types {

// Letters of names: of ASCII only, and the same in every locale of the process. `std::isalnum` takes bytes above 127
// for letters in a locale of 8 bits, and `std::tolower` keeps I in a Turkish one.

constexpr bool isDigit(char c) { return c >= '0' && c <= '9'; }
constexpr bool isLowerLetter(char c) { return c >= 'a' && c <= 'z'; }
constexpr bool isUpperLetter(char c) { return c >= 'A' && c <= 'Z'; }
constexpr bool isLetter(char c) { return isLowerLetter(c) || isUpperLetter(c); }

constexpr char lowered(char c) { return isUpperLetter(c) ? static_cast<char>(c - 'A' + 'a') : c; }
constexpr char raised(char c) { return isLowerLetter(c) ? static_cast<char>(c - 'a' + 'A') : c; }

inline std::string lowered(std::string text) {
    for (char& c : text) c = lowered(c);
    return text;
}

}  // namespace insonify::types
