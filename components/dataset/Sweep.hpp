#pragma once
// What a data set is made of: scenes x poses x settings.
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/output/PlainPicture.hpp"
#include "components/pose/SeaMotion.hpp"
#include "types/Describe.hpp"

namespace insonify::dataset {

/** What a sample is written as. */
enum class Format { Coco, Yolo, Mask, Npz, Mcap };

/** The parts of a data set. */
enum class Part { Train, Val, Test };

/** Values of one coordinate: one or several that are listed, steps from one to another, or drawn at random. */
struct Axis {
    std::vector<double> values;
    std::optional<double> from, to;
    std::optional<uint32_t> count;
    std::vector<double> uniform, normal;

    bool isDrawn() const { return !uniform.empty() || !normal.empty(); }
    /** Values of a grid, at least one; 0 where nothing is given. */
    uint64_t stepCount() const;
    double step(uint64_t number) const;
    /** The value of one pose of many: drawn by a random word, in whole millionths, so that processors that differ in
     *  the last bit of a logarithm draw the same; or the one that is given. */
    double draw(uint64_t random) const;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"from", "", "first of `count` steps", -1e7, 1e7}, self.from);
        visit(Field{"to", "", "last of `count` steps", -1e7, 1e7}, self.to);
        visit(Field{"count", "1", "steps", 1, 1e6}, self.count);
        visit(Field{"uniform", "", "drawn from between two values: [lowest, highest]", -1e7, 1e7}, self.uniform);
        visit(Field{"normal", "", "drawn from a normal law: [mean, deviation]", -1e7, 1e7}, self.normal);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** Poses of the vehicle in the world, coordinate by coordinate; what is not given is 0. */
struct PoseAxes {
    Axis x, y, z, roll_deg, pitch_deg, yaw_deg;

    /** visit(name, unit, axis) for each, in the order in which a grid nests: the last runs fastest. */
    template <class Self, class V>
    static void forEach(Self& self, V&& visit) {
        visit("x", "m", self.x);
        visit("y", "m", self.y);
        visit("z", "m", self.z);
        visit("roll_deg", "deg", self.roll_deg);
        visit("pitch_deg", "deg", self.pitch_deg);
        visit("yaw_deg", "deg", self.yaw_deg);
    }
    /** Poses of the grid; 10^12 where there are more. */
    uint64_t gridSize() const;
};

/** Poses of a trajectory at even times. */
struct TrajectoryPoses {
    std::string file;
    std::optional<uint32_t> count;
    std::optional<double> period;
    std::optional<double> from, to;
    std::optional<pose::SeaMotionConfig> motion = {};
    int line = 0, column = 0;  ///< Where it stands in the sweep.

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"file", "", "CSV with header time,x,y,z,qw,qx,qy,qz, relative to the sweep"}, self.file);
        visit(Field{"count", "1", "poses, evenly from `from` to `to`", 1, 1e6}, self.count);
        visit(Field{"period", "s", "instead: time between two poses", 1e-3, 1e6}, self.period);
        visit(Field{"from", "s", "time of the first; absent: the start of the trajectory", 0, 1e10}, self.from);
        visit(Field{"to", "s", "time of the last; absent: the end of the trajectory", 0, 1e10}, self.to);
        visit(Field{"motion", "", "of the carrier on waves, on top of the trajectory; absent: none"}, self.motion);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** Lines of a side-scan: each sample is a run of pings, which begins at its pose. */
struct LinesConfig {
    uint32_t count = 200;
    double period = 0.1;          ///< [s]
    std::optional<double> speed;  ///< Straight ahead at the pose's depth; of a trajectory its own [m/s].
    std::optional<pose::SeaMotionConfig> motion = {};
    int line = 0, column = 0;  ///< Where it stands in the sweep.

    double duration() const { return period * (count - 1); }  ///< From the first to the last [s].

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"count", "1", "lines of a sample", 2, 10000}, self.count);
        visit(Field{"period", "s", "between two lines", 1e-3, 1e3}, self.period);
        visit(Field{"speed", "m/s", "straight ahead by the pose's heading; with a trajectory absent, as it has its own",
                    0, 100},
              self.speed);
        visit(Field{"motion", "", "of the carrier on waves, on top of the straight way; absent: none"}, self.motion);
    }
};

enum class Frame { World, Vehicle };

/** Objects of the scene that stand elsewhere in each pose, without touching each other. */
struct ObjectGroup {
    std::vector<std::string> names, avoid;
    std::optional<std::string> ground;
    Frame frame = Frame::World;
    std::vector<double> x, y, z, roll_deg, pitch_deg, yaw_deg, scale;
    bool any_turn = false;
    double gap = 0.1;
    std::vector<uint32_t> count;
    int line = 0, column = 0;  ///< Where it stands in the sweep.

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"names", "", "nodes of the scene; a * stands for any letters"}, self.names);
        visit(Field{"x", "m", "area: [least, most], north in the world, ahead of the vehicle", -1e7, 1e7}, self.x);
        visit(Field{"y", "m", "area: [least, most], west in the world, to port of the vehicle", -1e7, 1e7}, self.y);
        visit(Field{"z", "m", "height of the node's origin: [least, most]; absent: as in the file, or on the ground",
                    -1e5, 1e5},
              self.z);
        visit(Field{"ground", "", "instead of z: node on whose highest surface they stand; a * stands for any letters"},
              self.ground);
        visit(Field{"yaw_deg", "deg", "turn about the vertical, beside that in the file: [least, most]", -360, 360},
              self.yaw_deg);
        visit(Field{"roll_deg", "deg", "before yaw_deg, turn about the world's x axis: [least, most]", -360, 360},
              self.roll_deg);
        visit(Field{"pitch_deg", "deg", "between the two, turn about the y axis: [least, most]", -360, 360},
              self.pitch_deg);
        visit(Field{"any_turn", "", "instead of the three: turned any way, each equally likely"}, self.any_turn);
        visit(Field{"scale", "1", "how many times as large as in the file: [least, most], another for each", 1e-3, 1e3},
              self.scale);
        visit(Field{"frame", "", "of the area: world, or vehicle, by its place and heading"}, self.frame);
        visit(Field{"gap", "m", "between upright cylinders about them", 0, 1e4}, self.gap);
        visit(Field{"avoid", "", "nodes that stay where they are, from whose boxes they keep off"}, self.avoid);
        visit(Field{"count", "1", "how many of them are there: [least, most]; absent: all", 0, 1e6}, self.count);
    }
    bool tilts() const { return any_turn || !roll_deg.empty() || !pitch_deg.empty(); }
    void check(types::Diagnostics& diagnostics) const;
};

/** Which share of the samples belongs to which part. */
struct Split {
    double train = 1, val = 0, test = 0;

    /** Of a sample, by its number alone: the same however many there are. */
    Part of(uint64_t seed, uint64_t index) const;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"train", "1", "share of the samples to learn from", 0, 1}, self.train);
        visit(Field{"val", "1", "to choose by", 0, 1}, self.val);
        visit(Field{"test", "1", "to judge by", 0, 1}, self.test);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** What is worth an annotation. */
struct AnnotationConfig {
    double min_share = 0.5;
    uint32_t min_level = 1;
    uint32_t min_pixels = 12;
    bool shadows = false;
    bool ghosts = false;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"min_share", "1", "of a bin's energy that is the object's, from which the bin is part of it", 0, 1},
              self.min_share);
        visit(Field{"min_level", "1", "grey level of the picture from which a place is seen", 0, 255}, self.min_level);
        visit(Field{"min_pixels", "1", "of an object, from which it is annotated", 1, 1e6}, self.min_pixels);
        visit(Field{"shadows", "", "annotates the shadow of each object as well, in a class of its own"}, self.shadows);
        visit(Field{"ghosts", "", "annotates what came by the water surface or other mirrors, in the class ghost"},
              self.ghosts);
    }
};

/** A value in YAML, and where it stands in the sweep. */
struct Written {
    std::string yaml;
    int line = 0, column = 0;
};

/** A property of the deployment that takes the values of a list. */
struct Setting {
    std::string property;  ///< "task.property.path"
    std::vector<Written> values;
};

/** A property of the deployment that each sample draws a value of: from a law, or one of `choice`. */
struct DrawnSetting {
    std::string property;  ///< "task.property.path"
    Axis law;
    std::vector<Written> choice;
    int line = 0, column = 0;  ///< Where it stands in the sweep.

    /** The value in YAML that a random word gives. */
    std::string draw(uint64_t random) const;
};

/** One of the scenes: a file, and properties that go with it. */
struct SceneChoice {
    std::string file;                                  ///< Empty: that of the deployment.
    std::string recipe = {};                           ///< By which the file is made; empty: it is there.
    uint64_t seed = 1;                                 ///< Of the recipe.
    std::vector<std::pair<std::string, Written>> set;  ///< "task.property.path"
    int line = 0, column = 0;
};

/** A class of objects, and which names are of it; a * stands for any letters. */
struct ClassRule {
    std::string name;
    std::vector<std::string> patterns;
    int line = 0, column = 0;
};

/** Every sample is one of `scenes`, with one combination of the values of `settings`, at one pose. What is `drawn` it
 *  has of its own. */
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
    int picture_line = 0, picture_column = 0;  ///< Where its shape stands in the sweep.
    AnnotationConfig annotations;
};

/** Whether a name is what a pattern says, in which * stands for any letters or none. */
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
