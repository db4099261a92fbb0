#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/dataset/Sweep.hpp"
#include "types/Extent.hpp"
#include "types/Geometry.hpp"
#include "types/Pose.hpp"

namespace insonify::dataset {

/** A node of a scene that can be put elsewhere. */
struct Placeable {
    types::Pose filed;  ///< Where the file has it, as a pose of the node.
    double radius = 0;  ///< Radius of an upright cylinder about the node's origin that holds it, whatever its yaw [m].
    double low = 0;     ///< Of its lowest point, above the node's origin [m].
    /** Its vertices from the origin in the world's axes, as the file turns them; empty where no group tilts it. */
    std::vector<glm::vec3> points;
};

/** What placing objects takes of a scene. */
struct SceneParts {
    std::vector<std::string> nodes;  ///< Names of all nodes, whether with a mesh or not.
    std::map<std::string, Placeable> placeables;
    std::map<std::string, types::Extent> boxes;                             ///< Of nodes that are kept off.
    std::map<std::string, std::vector<std::array<glm::dvec3, 3>>> grounds;  ///< Triangles of nodes that are stood on.
};

/** An object as one sample has it. */
struct PlacedObject {
    std::string name;
    types::Pose at;
    bool present = true;  ///< Else it is out of hearing, far below.
    double scale = 1;     ///< How many times as large as in the file [1].
};

/** Where the vehicle is, and when since the start [s]. */
struct TimedPose {
    double time;  ///< [s]
    types::Pose at;
};

/** What one sample is of. It depends on its own number alone: whoever makes it, and whatever else is made, it is the
 *  same. Poses and places of objects are those of the pose's number, the same in each scene and setting. Drawn settings
 *  are those of the sample's number. */
struct Sample {
    uint64_t index = 0;
    size_t scene = 0, setting = 0;  ///< Numbers in Sweep::scenes, and of the combination of settings.
    uint64_t pose = 0;
    std::vector<TimedPose> run;  ///< A pose for each of its pings, at least one.
    std::vector<PlacedObject> objects;
    std::vector<std::pair<std::string, std::string>> settings;  ///< "task.property" and YAML: listed ones, drawn ones.
    uint64_t seed = 1;                                          ///< Seed of noise and the like; not 0.
    Part part = Part::Train;
};

/** All samples of a sweep. The last pose runs fastest, then settings, of which the last named runs fastest, then
 *  scenes. */
class Samples {
public:
    /** @param trajectory the run of each pose of Sweep::trajectory, empty without; @param scenes one for each of
     *  Sweep::scenes. Throws types::ConfigError for names of objects that no scene has, and for more than 10^8 samples.
     */
    Samples(const Sweep& sweep, std::vector<std::vector<TimedPose>> trajectory, std::vector<SceneParts> scenes);

    uint64_t count() const { return count_; }
    uint64_t poses() const { return poses_; }
    uint64_t settings() const { return settings_; }
    /** Throws types::ConfigError where its objects have no room. */
    Sample at(uint64_t index) const;
    /** Values of the settings of a combination, "task.property" and YAML. */
    std::vector<std::pair<std::string, std::string>> settingsOf(size_t setting) const;
    /** Names of all that is placed in a scene. */
    std::vector<std::string> objectsOf(size_t scene) const;

private:
    std::vector<TimedPose> runOf(uint64_t pose) const;
    std::vector<PlacedObject> place(size_t scene, uint64_t pose, const types::Pose& vehicle) const;
    /** Throws where a pattern of a group matches in none of the scenes. */
    void refuseUnmatched(size_t group) const;
    std::vector<std::string> namesOf(size_t scene, size_t group) const;

    const Sweep& sweep_;
    std::vector<std::vector<TimedPose>> trajectory_;
    std::vector<SceneParts> scenes_;
    std::vector<std::vector<std::vector<std::string>>> names_;  ///< Of each scene and group, patterns resolved.
    uint64_t poses_ = 0, settings_ = 1, count_ = 0;
};

/** The random word by which a sample draws the setting `number` of Sweep::drawn. */
uint64_t wordOf(const Sweep& sweep, uint64_t index, size_t number);

/** Names that one of the patterns matches, in order. Throws types::ConfigError, as of `what` in the sweep, for a
 *  pattern that matches none.
 *  @param where what has the known names */
std::vector<std::string> resolve(const Sweep& sweep, const std::vector<std::string>& patterns,
                                 const std::vector<std::string>& known, const std::string& what, int line, int column,
                                 const char* where = "the scene");

}  // namespace insonify::dataset
