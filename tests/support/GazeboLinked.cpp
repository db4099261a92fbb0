// Programs that are linked with the reader need no component library.
#include "components/gazebo/World.hpp"

namespace {

[[maybe_unused]] const bool linked = [] {
    insonify::scene::setWorldReader(
        [](const insonify::scene::GazeboConfig& config, const std::filesystem::path& folder,
           insonify::scene::Scene& scene) { scene = insonify::gazebo::readWorld(config, folder); });
    return true;
}();

}  // namespace
