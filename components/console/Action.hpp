#pragma once
#include <CLI/App.hpp>  // CLI11 needs all three headers
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <functional>
#include <string>

namespace insonify::console {

/** Executes the command line and returns the exit code. */
using Action = std::function<int()>;

std::string refuseUnlessWhole(const std::string& text);     ///< Why it is not a uint64_t; empty when it is.
std::string refuseUnlessPositive(const std::string& text);  ///< Why it is not a number above 0; empty when it is.

}  // namespace insonify::console
