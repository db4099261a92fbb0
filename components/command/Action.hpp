#pragma once
#include <functional>

namespace insonify::command {

/** Executes the command line and returns the exit code. */
using Action = std::function<int()>;

}  // namespace insonify::command
