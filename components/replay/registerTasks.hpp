#pragma once
#include "components/framework/Registry.hpp"

namespace insonify::replay {

void registerTasks(framework::Registry& registry);

}  // namespace insonify::replay
