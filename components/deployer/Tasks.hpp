#pragma once
#include "components/framework/Registry.hpp"

namespace insonify::deployer {

/** Returns the task types of the core; types of component libraries are loaded when a deployment names them. */
framework::Registry coreTasks();

/** Returns also the types of all available component libraries. A library that cannot be loaded is a notice on
 *  stderr. */
framework::Registry allTasks();

}  // namespace insonify::deployer
