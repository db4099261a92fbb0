#pragma once
#include "components/console/Action.hpp"

namespace insonify::dataset {

/** Adds the command `dataset` with its options to `app`; parsing it sets `action`. */
void addCommand(CLI::App& app, console::Action& action);

}  // namespace insonify::dataset
