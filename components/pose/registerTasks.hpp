#pragma once
#include "components/framework/Registry.hpp"

namespace insonify::pose {

void registerTasks(framework::Registry& registry);

}  // namespace insonify::pose
