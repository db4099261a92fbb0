#include "components/receiver/registerTasks.hpp"

#include "components/receiver/ReceiverTask.hpp"

namespace insonify::receiver {

void registerTasks(framework::Registry& registry) {
    registry.add<ReceiverTask>("receiver::ReceiverTask", "amplifies pings (TVG, gain) and gives them out by a law");
}

}  // namespace insonify::receiver
