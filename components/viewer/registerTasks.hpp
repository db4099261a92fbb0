#pragma once
#include "components/framework/Registry.hpp"

namespace insonify::viewer {

void registerTasks(framework::Registry& registry);

}  // namespace insonify::viewer
