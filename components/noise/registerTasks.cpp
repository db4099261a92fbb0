#include "components/noise/registerTasks.hpp"

#include "components/noise/NoiseTask.hpp"

namespace insonify::noise {

void registerTasks(framework::Registry& registry) {
    registry.add<NoiseTask>("noise::NoiseTask", "puts speckle and background noise into pings");
}

}  // namespace insonify::noise
