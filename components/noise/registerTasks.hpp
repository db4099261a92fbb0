#pragma once
#include "components/framework/Registry.hpp"

namespace insonify::noise {

void registerTasks(framework::Registry& registry);

}  // namespace insonify::noise
