#pragma once
// Rejected input and its messages.
#include <string>
#include <vector>

#include "types/ConfigError.hpp"

namespace insonify::test {

/** Returns the text of the types::ConfigError that a call throws; empty if it throws none. */
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
