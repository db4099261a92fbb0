#pragma once
// Rejected input and its messages.
#include <string>
#include <vector>

#include "types/text/ConfigError.hpp"

namespace insonify::test {

inline std::vector<std::string> getTexts(const types::Diagnostics& diagnostics) {
    std::vector<std::string> texts;
    for (const types::Diagnostic& diagnostic : diagnostics) texts.push_back(diagnostic.text());
    return texts;
}

/** Returns the texts of the diagnostics that check() of a configuration or task reports. */
std::vector<std::string> countRefusals(const auto& checked) {
    types::Diagnostics diagnostics;
    checked.check(diagnostics);
    return getTexts(diagnostics);
}

/** Returns the texts of the types::ConfigError that a call throws; empty if it throws none. */
std::vector<std::string> refused(auto&& call) {
    try {
        call();
    } catch (const types::ConfigError& error) {
        return getTexts(error.diagnostics());
    }
    return {};
}

/** Returns the message of the `Error` that a call throws; empty if it throws none. */
template <class Error, class Call>
std::string computeError(Call&& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

}  // namespace insonify::test
