#pragma once
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "components/scene/GazeboWorld.hpp"
#include "components/scene/Scene.hpp"

namespace insonify::gazebo {

/** The scene of a world, and the names of all entities of the world. */
struct World {
    scene::Scene scene;
    std::set<std::string> names;  ///< Names of models, links, visuals and lights, each without its scope.
};

/** Requests the models of a world from Gazebo, see scene::sharedWorld(). */
scene::Scene readWorld(const scene::GazeboConfig& config, const std::filesystem::path& folder);

/** Requests the SDF of a world from Gazebo, see scene::requestSdf(). */
std::string requestSdf(const scene::GazeboConfig& config);

/** Makes a scene from the bytes of Gazebo's message Scene.
 *
 *  Each model and link is a node, named by its scope ("rov::arm::hand"), below the node of its model. Objects are the
 *  visuals. Gazebo may run on another machine. Meshes and pictures are therefore searched at the path in the message,
 *  then by the last parts of the path in the folders of meshes::ModelPaths. Geometry::notices lists visuals that cannot
 *  be shown. Throws types::ConfigError when the bytes are no Scene, or the Scene has too many parts. */
World getWorld(std::string_view message, const std::filesystem::path& folder);

/** Returns the names in a world when its scene was last read in this process; none when it was not read. */
std::optional<std::set<std::string>> namesTaken(const std::string& world, const std::string& partition);

}  // namespace insonify::gazebo
