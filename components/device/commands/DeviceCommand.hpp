#pragma once
#include "components/console/Action.hpp"

namespace insonify::device {

/** Adds the command `device` with its options to `app`; parsing it sets `action`. */
void addCommand(CLI::App& app, console::Action& action);

}  // namespace insonify::device
