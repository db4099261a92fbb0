#pragma once
#include <stdexcept>
#include <string>

namespace insonify::types {

/** Throws an Error, "<what> has other numbers of bins than it says", for a sample that contradicts itself, as its
 *  `diagnostic()` tells; nothing for one that cannot. `where` are the arguments of the Error before its text. */
template <class Error = std::invalid_argument, class Sample, class... Where>
void requireSound(const Sample& sample, const std::string& what, const Where&... where) {
    if constexpr (requires { sample.diagnostic(); })
        if (const char* const diagnostic = sample.diagnostic()) throw Error(where..., what + " " + diagnostic);
}

}  // namespace insonify::types
