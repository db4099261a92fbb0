#pragma once
#include "components/framework/Registry.hpp"

namespace insonify::receiver {

void registerTasks(framework::Registry& registry);

}  // namespace insonify::receiver
