#pragma once
// The definition of a data set: scenes x poses x settings.
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/output/pictures/PlainPicture.hpp"
#include "components/pose/SeaMotion.hpp"
#include "components/pose/Trajectory.hpp"
#include "types/text/Describe.hpp"

namespace insonify::dataset {

/** The file format of samples. */
enum class Format { Coco, Yolo, Mask, Npz, Mcap };

/** The parts of a data set. */
enum class Part { Train, Val, Test };

/** Values of one coordinate: a list of one or several, steps in an interval, or drawn at random. */
struct Axis {
    std::vector<double> values;
    std::optional<double> from, to;
    std::optional<uint32_t> count;
    std::vector<double> uniform, normal;

    bool isDrawn() const { return !uniform.empty() || !normal.empty(); }
    /** Returns the number of values in a grid, at least one; 0 if no value is given. */
    uint64_t stepCount() const;
    double step(uint64_t number) const;
    /** Returns the value of one of many poses: drawn with a random word, or the given value. Drawn values are whole
     *  millionths, so that processors that differ in the last bit of a logarithm draw the same. */
    double draw(uint64_t random) const;

    static void describe(auto& self, auto& visit) {
        visit({"from", "", "first of `count` steps", -1e7, 1e7}, self.from);
        visit({"to", "", "last of `count` steps", -1e7, 1e7}, self.to);
        visit({"count", "1", "steps", 1, 1e6}, self.count);
        visit({"uniform", "", "drawn uniformly: [min, max]", -1e7, 1e7}, self.uniform);
        visit({"normal", "", "drawn from a normal law: [mean, deviation]", -1e7, 1e7}, self.normal);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** Poses of the vehicle in the world, by coordinate; an absent coordinate is 0. */
struct PoseAxes {
    Axis x, y, z, roll_deg, pitch_deg, yaw_deg;

    /** Calls visit(name, unit, axis) for each axis, in the order in which a grid nests: the last varies fastest. */
    static void forEach(auto& self, auto&& visit) {
        visit("x", "m", self.x);
        visit("y", "m", self.y);
        visit("z", "m", self.z);
        visit("roll_deg", "deg", self.roll_deg);
        visit("pitch_deg", "deg", self.pitch_deg);
        visit("yaw_deg", "deg", self.yaw_deg);
    }
    /** Returns the number of poses of the grid, at most 10^12. */
    uint64_t gridSize() const;
};

/** Poses of a trajectory at equal intervals of time. */
struct TrajectoryPoses {
    std::string file;
    std::optional<uint32_t> count;
    std::optional<double> period;
    std::optional<double> from, to;
    std::optional<pose::SeaMotionConfig> motion = {};
    pose::TrajectoryTimes times = {};
    types::WorldFrame world_frame = types::WorldFrame::AsIs;
    int line = 0, column = 0;  ///< Its place in the sweep.

    static void describe(auto& self, auto& visit) {
        visit({"file", "", "CSV with header time,x,y,z,qw,qx,qy,qz, or of TUM or EuRoC; relative to the sweep"},
              self.file);
        pose::TrajectoryTimes::describe(self.times, visit);
        visit(pose::world_frame_of_file, self.world_frame);
        visit({"count", "1", "poses, evenly from `from` to `to`", 1, 1e6}, self.count);
        visit({"period", "s", "instead: time between two poses", 1e-3, 1e6}, self.period);
        visit({"from", "s", "time of the first; absent: the start of the trajectory", 0, 1e10}, self.from);
        visit({"to", "s", "time of the last; absent: the end of the trajectory", 0, 1e10}, self.to);
        visit({"motion", "", "of the carrier on waves, on top of the trajectory; absent: none"}, self.motion);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** Lines of a side-scan: each sample is a run of pings that begins at the sample's pose. */
struct LinesConfig {
    uint32_t count = 200;
    double period = 0.1;          ///< [s]
    std::optional<double> speed;  ///< Straight ahead at the pose's depth [m/s]; absent with a trajectory.
    std::optional<pose::SeaMotionConfig> motion = {};
    int line = 0, column = 0;  ///< Its place in the sweep.

    double duration() const { return period * (count - 1); }  ///< Time from the first to the last line [s].

    static void describe(auto& self, auto& visit) {
        visit({"count", "1", "lines of a sample", 2, 10000}, self.count);
        visit({"period", "s", "between two lines", 1e-3, 1e3}, self.period);
        visit({"speed", "m/s", "straight ahead by the pose's heading; with a trajectory absent, as it has its own", 0,
               100},
              self.speed);
        visit({"motion", "", "of the carrier on waves, on top of the straight way; absent: none"}, self.motion);
    }
};

enum class Frame { World, Vehicle };

/** Objects of the scene that are placed anew in each pose, without touching each other. */
struct ObjectGroup {
    std::vector<std::string> names, avoid;
    std::optional<std::string> ground;
    Frame frame = Frame::World;
    std::vector<double> x, y, z, roll_deg, pitch_deg, yaw_deg, scale;
    bool any_turn = false;
    double gap = 0.1;
    std::vector<uint32_t> count;
    int line = 0, column = 0;  ///< Its place in the sweep.

    static void describe(auto& self, auto& visit) {
        visit({"names", "", "nodes of the scene; a * matches any letters"}, self.names);
        visit({"x", "m", "area: [min, max], north in the world, ahead of the vehicle", -1e7, 1e7}, self.x);
        visit({"y", "m", "area: [min, max], west in the world, to port of the vehicle", -1e7, 1e7}, self.y);
        visit(
            {"z", "m", "height of the node's origin: [min, max]; absent: as in the file, or on the ground", -1e5, 1e5},
            self.z);
        visit({"ground", "", "instead of z: node on whose highest surface they are placed; a * matches any letters"},
              self.ground);
        visit({"yaw_deg", "deg", "turn about the vertical, in addition to that in the file: [min, max]", -360, 360},
              self.yaw_deg);
        visit({"roll_deg", "deg", "before yaw_deg, turn about the world's x axis: [min, max]", -360, 360},
              self.roll_deg);
        visit({"pitch_deg", "deg", "between the two, turn about the y axis: [min, max]", -360, 360}, self.pitch_deg);
        visit({"any_turn", "", "instead of the three: turned any way, each equally likely"}, self.any_turn);
        visit({"scale", "1", "factor of the size in the file: [min, max], drawn for each", 1e-3, 1e3}, self.scale);
        visit({"frame", "", "of the area: world, or vehicle, by its place and heading"}, self.frame);
        visit({"gap", "m", "between upright cylinders about them", 0, 1e4}, self.gap);
        visit({"avoid", "", "nodes whose boxes they keep clear of"}, self.avoid);
        visit({"count", "1", "number of them that are present: [min, max]; absent: all", 0, 1e6}, self.count);
    }
    bool tilts() const { return any_turn || !roll_deg.empty() || !pitch_deg.empty(); }
    void check(types::Diagnostics& diagnostics) const;
};

/** The share of the samples in each part. */
struct Split {
    double train = 1, val = 0, test = 0;

    /** Returns the part of a sample. It depends only on the sample's number, not on the number of samples. */
    Part of(uint64_t seed, uint64_t index) const;

    static void describe(auto& self, auto& visit) {
        visit({"train", "1", "share of the samples for training", 0, 1}, self.train);
        visit({"val", "1", "for validation", 0, 1}, self.val);
        visit({"test", "1", "for tests", 0, 1}, self.test);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** Criteria for annotations. */
struct AnnotationConfig {
    double min_share = 0.5;
    uint32_t min_level = 1;
    uint32_t min_pixels = 12;
    bool shadows = false;
    bool ghosts = false;

    static void describe(auto& self, auto& visit) {
        visit({"min_share", "1", "min share of a bin's energy that comes from its object", 0, 1}, self.min_share);
        visit({"min_level", "1", "min grey level of an annotated pixel", 0, 255}, self.min_level);
        visit({"min_pixels", "1", "min pixels of an annotated object", 1, 1e6}, self.min_pixels);
        visit({"shadows", "", "annotates the shadow of each object as well, in a class of its own"}, self.shadows);
        visit({"ghosts", "", "annotates echoes by the water surface or other mirrors, in the class ghost"},
              self.ghosts);
    }
};

/** A value in YAML, and its place in the sweep. */
struct Written {
    std::string yaml;
    int line = 0, column = 0;
};

/** A property of the deployment that takes the values of a list. */
struct Setting {
    std::string property;  ///< "task.property.path"
    std::vector<Written> values;
};

/** A property of the deployment whose value each sample draws: from a law, or from `choice`. */
struct DrawnSetting {
    std::string property;  ///< "task.property.path"
    Axis law;
    std::vector<Written> choice;
    int line = 0, column = 0;  ///< Its place in the sweep.

    /** Returns the value for a random word, in YAML. */
    std::string draw(uint64_t random) const;
};

/** One of the scenes: a file, and the properties that are set with it. */
struct SceneChoice {
    std::string file;                                  ///< Empty: the deployment's scene.
    std::string recipe = {};                           ///< The recipe that makes the file; empty: the file exists.
    uint64_t seed = 1;                                 ///< Seed of the recipe.
    std::vector<std::pair<std::string, Written>> set;  ///< "task.property.path"
    int line = 0, column = 0;
};

/** A class of objects, and its names; a * matches any letters. */
struct ClassRule {
    std::string name;
    std::vector<std::string> patterns;
    int line = 0, column = 0;
};

/** The sweep. A sample has one of the `scenes`, one combination of the values of `settings`, and one pose. It draws its
 *  own values of `drawn`. */
struct Sweep {
    std::string file;  ///< As given, for diagnostics.
    std::string text;
    uint64_t seed = 1;
    std::vector<SceneChoice> scenes{1};
    std::vector<Setting> settings;
    std::vector<DrawnSetting> drawn;
    // Exactly one of these:
    std::optional<PoseAxes> grid;
    std::optional<PoseAxes> random;
    uint32_t random_count = 0;
    std::optional<TrajectoryPoses> trajectory;
    std::optional<LinesConfig> lines;
    std::vector<ObjectGroup> objects;
    Split split;
    std::vector<ClassRule> classes;
    output::PlainConfig picture;
    int picture_line = 0, picture_column = 0;  ///< Place of the picture's shape in the sweep.
    AnnotationConfig annotations;
};

/** Returns whether a name matches a pattern, in which * matches any number of letters. */
bool matches(const std::string& pattern, const std::string& name);

}  // namespace insonify::dataset

template <>
struct insonify::types::EnumNames<insonify::dataset::Format> {
    static constexpr std::string_view names[] = {"coco", "yolo", "mask", "npz", "mcap"};
};
template <>
struct insonify::types::EnumNames<insonify::dataset::Part> {
    static constexpr std::string_view names[] = {"train", "val", "test"};
};
template <>
struct insonify::types::EnumNames<insonify::dataset::Frame> {
    static constexpr std::string_view names[] = {"world", "vehicle"};
};
