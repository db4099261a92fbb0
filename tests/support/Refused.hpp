#pragma once
// What is refused, and with which words.
#include <string>
#include <vector>

#include "types/ConfigError.hpp"

namespace insonify::test {

/** The diagnostics of a call that throws types::ConfigError, as they are told; none where it throws nothing. */
template <class Call>
std::vector<std::string> refused(Call&& call) {
    std::vector<std::string> texts;
    try {
        call();
    } catch (const types::ConfigError& error) {
        for (const types::Diagnostic& diagnostic : error.diagnostics()) texts.push_back(diagnostic.text());
    }
    return texts;
}

}  // namespace insonify::test
