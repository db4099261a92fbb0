#pragma once
#include <concepts>
#include <cstdio>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>

namespace insonify::types {

/** A check of the program itself has failed: an error of the program, never of its input. */
class CheckFailure : public std::logic_error {
public:
    using std::logic_error::logic_error;
};

/** The text of a value that a failed check prints: a number, a text, or the coordinates of a vector. */
struct CheckedValue {
    CheckedValue(const std::convertible_to<std::string_view> auto& value) : text(std::string_view(value)) {}
    CheckedValue(std::integral auto value) : text(std::to_string(value)) {}
    CheckedValue(std::floating_point auto value) {
        char digits[32];
        std::snprintf(digits, sizeof digits, "%.9g", static_cast<double>(value));
        text = digits;
    }
    template <class Vector>
    requires requires(const Vector& value) { value.z; }
    CheckedValue(const Vector& value)
        : text('(' + CheckedValue(value.x).text + ", " + CheckedValue(value.y).text + ", " +
               CheckedValue(value.z).text + ')') {}

    std::string text;
};

/** Throws CheckFailure: "an error of the program in Truth.cpp:140: bin < bins does not hold; bin, bins: 50, 40". */
[[noreturn, gnu::cold, gnu::noinline]] inline void failCheck(const char* file, int line, const char* condition,
                                                             const char* names,
                                                             std::initializer_list<CheckedValue> values) {
    std::string text = std::string("an error of the program in ") + file + ':' + std::to_string(line) + ": " +
                       condition + " does not hold";
    const char* before = ": ";
    if (values.size() > 0) text += std::string("; ") + names;
    for (const CheckedValue& value : values) text += before + value.text, before = ", ";
    throw CheckFailure(text);
}

}  // namespace insonify::types

/** INSONIFY_CHECK(bin < bins, bin, bins) throws CheckFailure where the condition does not hold, with the place, the
 *  condition and the further arguments. It evaluates these only then, and nothing at all unless INSONIFY_CHECKS is
 *  defined, as in builds with tests, sanitizers or the fuzzer. Only in source files: code of a header would differ
 *  between targets. A condition with a comma needs parentheses. */
#ifdef INSONIFY_CHECKS
#define INSONIFY_CHECK(condition, ...)                                                                      \
    do {                                                                                                    \
        if (!(condition)) [[unlikely]]                                                                      \
            ::insonify::types::failCheck(__FILE_NAME__, __LINE__, #condition, #__VA_ARGS__, {__VA_ARGS__}); \
    } while (false)
#else
#define INSONIFY_CHECK(condition, ...)                                                    \
    do {                                                                                  \
        if constexpr (false) /* compiled, so that the check stays right */                \
            if (!(condition)) ::insonify::types::failCheck("", 0, "", "", {__VA_ARGS__}); \
    } while (false)
#endif
