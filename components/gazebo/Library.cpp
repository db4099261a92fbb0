// The component library gazebo, which is loaded by deployments that name a type of this namespace, or a world of Gazebo
// as their scene.
#include "components/gazebo/PoseTask.hpp"
#include "components/gazebo/World.hpp"
#include "components/loader/Interface.hpp"

INSONIFY_COMPONENT_LIBRARY;

extern "C" void insonify_register(insonify::framework::Registry& registry) {
    insonify::gazebo::registerTasks(registry);
}

extern "C" void insonify_request_sdf(const insonify::scene::GazeboConfig& config, std::string& text) {
    text = insonify::gazebo::requestSdf(config);
}

extern "C" void insonify_read_world(const insonify::scene::GazeboConfig& config, const std::filesystem::path& folder,
                                    insonify::scene::Scene& scene) {
    scene = insonify::gazebo::readWorld(config, folder);
}
