#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "components/dataset/Sweep.hpp"
#include "types/geometry/Extent.hpp"
#include "types/geometry/Geometry.hpp"
#include "types/samples/Pose.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::dataset {

/** A node of a scene that a sweep can move. */
struct Placeable {
    types::Pose filed;  ///< Its place in the file, as a pose of the node.
    double radius = 0;  ///< Radius of an upright cylinder about the node's origin that contains it at any yaw [m].
    double low = 0;     ///< Height of its lowest point above the node's origin [m].
    /** Its vertices from the origin in the world's axes, turned as in the file; empty if no group tilts it. */
    std::vector<glm::vec3> points;
};

/** The parts of a scene that are needed to place objects. */
struct SceneParts {
    std::vector<std::string> nodes;  ///< Names of all nodes, whether with a mesh or not.
    std::map<std::string, Placeable> placeables;
    std::map<std::string, types::Extent> boxes;                             ///< Boxes of the nodes to keep clear of.
    std::map<std::string, std::vector<std::array<glm::dvec3, 3>>> grounds;  ///< Triangles to place objects on.
};

/** A placed object of one sample. */
struct PlacedObject {
    std::string name;
    types::Pose at;
    bool present = true;  ///< False: it is far below, out of the sonar's reach.
    double scale = 1;     ///< Factor of the size in the file [1].
};

/** The pose of the vehicle at a time since the start [s]. */
struct TimedPose {
    double time;  ///< [s]
    types::Pose at;
};

/** The configuration of one sample. It depends only on the sample's number, not on the process that makes it or on the
 *  other samples. Poses and places of objects depend on the pose's number; they are the same in each scene and setting.
 *  Drawn settings depend on the sample's number. All settings of one pose in one scene are in the same part. */
struct Sample {
    uint64_t index = 0;
    size_t scene = 0, setting = 0;  ///< Index in Sweep::scenes, and number of the combination of settings.
    uint64_t pose = 0;
    std::vector<TimedPose> run;  ///< One pose per ping, at least one.
    std::vector<PlacedObject> objects;
    std::vector<std::pair<std::string, std::string>> settings;  ///< "task.property" and YAML: listed, then drawn.
    uint64_t seed = 1;                                          ///< Seed of noise and other random effects; not 0.
    Part part = Part::Train;
};

inline constexpr uint64_t max_samples = 100'000'000;  ///< Of one sweep.
inline constexpr uint64_t max_drawn = 10'000'000;     ///< Of these, by `--count`.

/** The numbers of the samples of a data set, in ascending order: all those of a sweep, or some drawn at random. */
class Selection {
public:
    /** All numbers below `total`. */
    explicit Selection(uint64_t total = 0) : size_(total) {}
    /** Draws `count` different numbers below `total`, each set equally likely; a larger count adds to a smaller one.
     *  Throws types::ConfigError at `--count` for a count of 0, and for one above `total` or max_drawn. */
    Selection(uint64_t total, uint64_t count, uint64_t seed);

    uint64_t size() const { return size_; }
    uint64_t operator[](uint64_t position) const { return drawn_.empty() ? position : drawn_[position]; }
    bool contains(uint64_t number) const {
        return drawn_.empty() ? number < size_ : std::ranges::binary_search(drawn_, number);
    }

private:
    uint64_t size_ = 0;
    std::vector<uint64_t> drawn_;
};

/** All samples of a sweep. The pose varies fastest, then the settings, of which the last named varies fastest, then the
 *  scene. */
class Samples {
public:
    /** @param trajectory the run of each pose of Sweep::trajectory; empty without one
     *  @param scenes one for each of Sweep::scenes
     *
     *  Throws types::ConfigError for names of objects that no scene has, and for more than 10^8 samples. */
    Samples(const Sweep& sweep, std::vector<std::vector<TimedPose>> trajectory, std::vector<SceneParts> scenes);

    uint64_t count() const { return count_; }
    uint64_t poses() const { return poses_; }
    uint64_t settings() const { return settings_; }
    /** Returns a sample. Throws types::ConfigError if its objects do not fit. */
    Sample at(uint64_t index) const;
    /** Returns the part of a sample. */
    Part getPart(uint64_t index) const;
    /** Returns the values of a combination of settings, "task.property" and YAML. */
    std::vector<std::pair<std::string, std::string>> getSettings(size_t setting) const;
    /** Returns the names of all objects that are placed in a scene. */
    std::vector<std::string> getObjects(size_t scene) const;

private:
    std::vector<PlacedObject> place(size_t scene, uint64_t pose, const types::Pose& vehicle) const;
    /** Throws if a pattern of a group matches in none of the scenes. */
    void refuseUnmatched(size_t group) const;
    /** Throws if the count of a group is larger than the number of its objects in each scene. */
    void refuseTooMany(size_t group) const;
    std::vector<std::string> getNames(size_t scene, size_t group) const;

    const Sweep& sweep_;
    std::vector<std::vector<TimedPose>> trajectory_;
    std::vector<SceneParts> scenes_;
    std::vector<std::vector<std::vector<std::string>>> names_;  ///< Per scene and group.
    uint64_t poses_ = 0, settings_ = 1, count_ = 0;
};

/** Returns the poses of one number of a sweep: a grid's, a drawn one, or that of its trajectory. */
std::vector<TimedPose> makeRun(const Sweep& sweep, const std::vector<std::vector<TimedPose>>& trajectory,
                               uint64_t pose);

/** Returns the number of poses of a sweep. @param trajectory as for Samples */
uint64_t countPoses(const Sweep& sweep, const std::vector<std::vector<TimedPose>>& trajectory);

/** What the poses of a sonar are compared with. */
struct Surroundings {
    std::optional<double> water_surface;                     ///< [m]
    std::shared_ptr<const types::Geometry> geometry;         ///< In the world; null: unknown.
    double range = std::numeric_limits<double>::infinity();  ///< Of the sonar [m].
    uint64_t step = 1;                                       ///< The numbers of the compared poses are multiples of it.
};

/** Returns a sentence, with count and first pose, for the positions of a sonar above the water surface, for those below
 *  the floor or inside of a body, and for those farther from the scene's box than the sonar's range [m]. */
std::vector<std::string> describeOddPoses(const std::vector<glm::dvec3>& positions, const Surroundings& around);

/** Returns a sentence if a part whose share is not 0 has none of these samples; empty: all have. */
std::string describeEmptyParts(const Sweep& sweep, const Selection& selection, const Samples& samples);

/** Returns the random word with which a sample draws the setting `number` of Sweep::drawn. */
uint64_t word(const Sweep& sweep, uint64_t index, size_t number);

/** Returns the errors of patterns without a match, at `what` of the sweep.
 *  @param where description of the place of the known names */
types::Diagnostics findUnmatched(const Sweep& sweep, const std::vector<std::string>& patterns,
                                 const std::vector<std::string>& known, const std::string& what, int line, int column,
                                 const char* where = "the scene");

/** Returns the names that match one of the patterns, in order. Throws types::ConfigError at `what` of the sweep for a
 *  pattern without a match.
 *  @param where description of the place of the known names */
std::vector<std::string> resolve(const Sweep& sweep, const std::vector<std::string>& patterns,
                                 const std::vector<std::string>& known, const std::string& what, int line, int column,
                                 const char* where = "the scene");

}  // namespace insonify::dataset
