#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "components/scene/Scene.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Describe.hpp"

namespace insonify::scene {

/** A world in Gazebo, whose models are the scene. */
struct GazeboConfig {
    std::string world, partition;
    double timeout = 5;

    static void describe(auto& self, auto& visit) {
        visit({"world", "", "name of Gazebo's world, which is asked for on /world/NAME/scene/info"}, self.world);
        visit({"partition", "", "of Gazebo's transport; empty: GZ_PARTITION, or IGN_PARTITION"}, self.partition);
        visit({"timeout", "s", "how long to wait for Gazebo's answer", 0.1, 3600}, self.timeout);
    }
    void check(types::Diagnostics& diagnostics) const;
    bool operator==(const GazeboConfig&) const = default;
};

/** Returns the models of a world, which the component library gazebo requests from Gazebo. Tasks that hold the scene of
 *  one world at the same time share it. Relative paths of meshes start at `folder`. Throws types::ConfigError with the
 *  key of GazeboConfig as its path if Gazebo does not answer or the world is empty. */
std::shared_ptr<const Scene> sharedWorld(const GazeboConfig& config, const std::filesystem::path& folder);

using WorldReader = void (*)(const GazeboConfig& config, const std::filesystem::path& folder, Scene& scene);
/** Replaces the reader that sharedWorld() uses, for programs that are linked with their reader. */
void setWorldReader(WorldReader reader);

}  // namespace insonify::scene
