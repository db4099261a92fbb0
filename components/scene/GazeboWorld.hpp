#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "components/scene/Scene.hpp"
#include "types/samples/Pose.hpp"
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

/** A sonar that a world's SDF describes: `<sensor type="custom" gz:type="insonify">` or `ignition:type`. */
struct SonarSensor {
    /** A property of the sonar's tasks. */
    struct Setting {
        std::string path;   ///< "water.depth" of the sonar, "noise.seed" of its noise, "receiver.tvg.max_db".
        std::string value;  ///< In YAML.
        int line = 0;       ///< In the SDF.
    };
    std::string name;        ///< With its scope, "rov::base::fls".
    std::string link;        ///< Of its link, "rov::base".
    types::Mount mount;      ///< In its link.
    double update_rate = 0;  ///< Simulated [Hz]; 0: each pose of the world.
    std::string topic;       ///< Empty: none is given.
    std::string type = "sonar::SonarTask";
    std::vector<Setting> settings;
    std::string file;  ///< Empty for a world that Gazebo runs.
    int line = 0;
};

/** What a world's SDF says of sonars. */
struct WorldSonars {
    std::string world;                ///< Name.
    std::vector<SonarSensor> sonars;  ///< In the order of the file.
    /** Entities that may move: models of the top level that are not `<static>`, each followed by the scopes of its
     *  links with visuals that joints may move within the model. */
    std::vector<std::string> moving;
    std::vector<std::string> others;  ///< Sensors of other types, with scope and type.
    std::vector<std::string> notices;
};

/** Reads the sonars of an SDF file, which the component library sdf does. Throws types::ConfigError with all
 *  diagnostics for a file that is no world, and for wrong sensors. */
WorldSonars readWorldSonars(const std::filesystem::path& file);

/** Returns the SDF of a world that Gazebo runs, with the models that it includes; the component library gazebo requests
 *  it. Throws types::ConfigError as sharedWorld(). */
std::string requestSdf(const GazeboConfig& config);

/** Returns the models of a world, which the component library gazebo requests from Gazebo. Tasks that hold the scene of
 *  one world at the same time share it. Relative paths of meshes start at `folder`. Throws types::ConfigError with the
 *  key of GazeboConfig as its path if Gazebo does not answer or the world is empty. */
std::shared_ptr<const Scene> sharedWorld(const GazeboConfig& config, const std::filesystem::path& folder);

using WorldReader = void (*)(const GazeboConfig& config, const std::filesystem::path& folder, Scene& scene);
/** Replaces the reader that sharedWorld() uses, for programs that are linked with their reader. */
void setWorldReader(WorldReader reader);

}  // namespace insonify::scene
