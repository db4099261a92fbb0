#pragma once
#include "components/framework/Registry.hpp"

namespace insonify::device {

/** Makes the tasks of this folder known to deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::device
