#pragma once
#include <functional>

namespace insonify::command {

/** What the command line asks for: does it and gives the exit code. */
using Action = std::function<int()>;

}  // namespace insonify::command
