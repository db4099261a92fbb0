#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "components/scene/GazeboWorld.hpp"
#include "components/scene/Scene.hpp"

namespace insonify::sdf {

/** A robot in URDF, prepared for libsdformat. */
struct Urdf {
    std::string text;  ///< With an inertia for each link, without which libsdformat omits it; fixed joints stay, all
                       ///< others turn freely.
    std::map<std::string, std::vector<std::string>> materials;  ///< Per link, of its visuals.
    std::vector<std::string> notices;                           ///< Visuals without a shape that is known.
};

/** Returns whether a file is URDF, by its extension. */
bool isUrdf(const std::filesystem::path& file);

/** Reads a robot. Throws types::ConfigError for text that is not XML, has no robot, or is a macro file that xacro has
 *  to expand, for shapes and origins without the numbers that they need, and for joints that make no tree. */
Urdf readUrdf(const std::filesystem::path& file, const std::string& text);

/** Reads a scene from SDF 1.2 to 1.9 with libsdformat: the first world of a file, or its model.
 *
 *  Each model and link is a node, named by its scope ("rov::arm::hand"). A link or nested model that a joint attaches
 *  to another link is below that link's node; every other node is below its model's node. Objects are the visuals.
 *  Geometry::notices lists includes, meshes and pictures that are not found, and the warnings of libsdformat. Files are
 *  searched by meshes::ModelPaths. */
scene::Scene readSdf(const std::filesystem::path& file);

/** See scene::readWorldSonars(). Elements of the block `<gz:insonify>` of a sensor, with any prefix, are properties:
 *  `type` is the sonar's task, `noise` and `receiver` are blocks of those tasks, and all others are of the sonar.
 *  Numbers with spaces between them are lists, and elements of one name too. */
scene::WorldSonars readSonars(const std::filesystem::path& file);

}  // namespace insonify::sdf
