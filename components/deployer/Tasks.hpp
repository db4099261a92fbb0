#pragma once
#include "components/framework/Registry.hpp"

namespace insonify::deployer {

/** The types of the core; those of component libraries are loaded when they are named. */
framework::Registry coreTasks();

/** Those of all component libraries that are here as well. One that cannot be loaded is a notice on stderr. */
framework::Registry allTasks();

}  // namespace insonify::deployer
