#pragma once
#include "components/framework/Registry.hpp"

namespace insonify::output {

void registerTasks(framework::Registry& registry);

}  // namespace insonify::output
