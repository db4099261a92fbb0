#pragma once
#include "components/framework/Registry.hpp"

namespace insonify::dds {

void registerTasks(framework::Registry& registry);

}  // namespace insonify::dds
