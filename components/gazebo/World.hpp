#pragma once
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "components/scene/GazeboWorld.hpp"
#include "components/scene/Scene.hpp"

namespace insonify::gazebo {

/** What of a world is a scene, and the names of all that the world has. */
struct World {
    scene::Scene scene;
    std::set<std::string> names;  ///< Names of models, links, visuals and lights, each without its scope.
};

/** Asks Gazebo for a world's models, see scene::sharedWorld(). */
scene::Scene readWorld(const scene::GazeboConfig& config, const std::filesystem::path& folder);

/** Makes a scene of the bytes of Gazebo's message Scene.
 *
 *  Each model and link is a node, named by its scope ("rov::arm::hand"), and below that of its model. Objects are the
 *  visuals. A mesh or picture is looked for where the message says, then by the last parts of its path in the folders
 *  of meshes::ModelPaths: Gazebo may run on another machine. What cannot be shown is in Geometry::notices. Throws
 *  types::ConfigError where the bytes are no Scene, or one of too many parts. */
World worldOf(std::string_view message, const std::filesystem::path& folder);

/** Names in the world when its scene was taken last in this process; none: it was not. */
std::optional<std::set<std::string>> namesTaken(const std::string& world, const std::string& partition);

}  // namespace insonify::gazebo
