#include "components/replay/registerTasks.hpp"

#include "components/replay/ReplayTask.hpp"

namespace insonify::replay {

void registerTasks(framework::Registry& registry) {
    registry.add<ReplayTask>("replay::ReplayTask", "publishes the streams of a pocolog file on ports");
}

}  // namespace insonify::replay
