#include "components/device/Tasks.hpp"

#include "components/device/MicronTask.hpp"
#include "components/device/Sonar3dTask.hpp"

namespace insonify::device {

void registerTasks(framework::Registry& registry) {
    registry.add<MicronTask>("device::MicronTask",
                             "stands in for a Tritech Micron, by SeaNet over TCP or a serial line");
    registry.add<Sonar3dTask>("device::Sonar3dTask", "stands in for a Water Linked Sonar 3D-15, by HTTP and UDP");
}

}  // namespace insonify::device
