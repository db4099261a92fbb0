#pragma once
#include <stdexcept>
#include <string>

namespace insonify::types {

/** Throws an Error such as "<what> has other numbers of bins than it says" for a sample with a `diagnostic()`. Does
 *  nothing for types without this function. `where` are the arguments of the Error before its text. */
template <class Error = std::invalid_argument, class Sample, class... Where>
void requireSound(const Sample& sample, const std::string& what, const Where&... where) {
    if constexpr (requires { sample.diagnostic(); })
        if (const char* const diagnostic = sample.diagnostic()) throw Error(where..., what + " " + diagnostic);
}

}  // namespace insonify::types
