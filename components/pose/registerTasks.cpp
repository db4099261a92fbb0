#include "components/pose/registerTasks.hpp"

#include "components/pose/TrajectoryTask.hpp"

namespace insonify::pose {

void registerTasks(framework::Registry& registry) {
    registry.add<TrajectoryTask>("pose::TrajectoryTask",
                                 "moves the vehicle along a trajectory from a file or waypoints");
}

}  // namespace insonify::pose
