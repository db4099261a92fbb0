#pragma once
#include "components/framework/Registry.hpp"

namespace insonify::sonar {

/** Makes the sonar tasks known to deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::sonar
