#pragma once
#include <CLI/App.hpp>

#include "components/command/Action.hpp"

namespace insonify::dataset {

/** Adds the command `dataset` with its options to `app`; parsing it sets `action`. */
void addCommand(CLI::App& app, command::Action& action);

}  // namespace insonify::dataset
