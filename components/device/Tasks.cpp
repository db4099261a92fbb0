#include "components/device/Tasks.hpp"

#include "components/device/OculusTask.hpp"

namespace insonify::device {

void registerTasks(framework::Registry& registry) {
    registry.add<OculusTask>("device::OculusTask", "stands in for a Blueprint Subsea Oculus: drivers connect to it");
}

}  // namespace insonify::device
