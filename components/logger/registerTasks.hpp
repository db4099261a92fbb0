#pragma once
#include "components/framework/Registry.hpp"

namespace insonify::logger {

void registerTasks(framework::Registry& registry);

}  // namespace insonify::logger
