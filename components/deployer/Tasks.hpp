#pragma once
#include "components/framework/Registry.hpp"

namespace insonify::deployer {

/** Every task that is built into the command. */
framework::Registry builtInTasks();

}  // namespace insonify::deployer
