#include "components/scene/registerTasks.hpp"

#include "components/scene/SceneTask.hpp"

namespace insonify::scene {

void registerTasks(framework::Registry& registry) {
    registry.add<SceneTask>("scene::SceneTask", "holds a scene and says what the sonar has before it at each pose");
}

}  // namespace insonify::scene
