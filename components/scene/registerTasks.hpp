#pragma once
#include "components/framework/Registry.hpp"

namespace insonify::scene {

void registerTasks(framework::Registry& registry);

}  // namespace insonify::scene
