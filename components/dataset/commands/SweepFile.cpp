#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "components/dataset/commands/DatasetRun.hpp"
#include "components/framework/config/ConfigReader.hpp"
#include "components/framework/config/YamlText.hpp"
#include "components/scene/SceneTask.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Sha256.hpp"

namespace insonify::dataset {
namespace {

/** Returns the node's objects in the axes of the world, about the node's origin, turned as in the file. */
Placeable makePlaceable(const scene::Scene& scene, const std::vector<scene::Part>& parts, bool tilts) {
    const types::Geometry& geometry = *scene.geometry;
    const scene::Part& first = parts.front();
    const glm::dmat4 world_from_body =
        geometry.objects[first.object].world_from_object * glm::inverse(first.body_from_object);
    Placeable placeable;
    placeable.filed.source_frame = "body";
    placeable.filed.target_frame = "world";
    placeable.filed.position = world_from_body[3];
    placeable.filed.orientation = glm::normalize(glm::quat_cast(glm::dmat3(world_from_body)));
    bool any = false;
    for (const scene::Part& part : parts)
        for (const glm::vec3& vertex :
             geometry.meshes[static_cast<size_t>(geometry.objects[part.object].mesh)].positions) {
            const glm::dvec3 in_body = part.body_from_object * glm::dvec4(vertex, 1);
            const glm::dvec3 turned = placeable.filed.orientation * in_body;
            placeable.radius = std::max(placeable.radius, std::hypot(turned.x, turned.y));
            placeable.low = any ? std::min(placeable.low, turned.z) : turned.z;
            if (tilts) placeable.points.emplace_back(turned);
            any = true;
        }
    return placeable;
}

types::Extent makeBox(const scene::Scene& scene, const std::vector<scene::Part>& parts) {
    types::Extent box;
    for (const scene::Part& part : parts) {
        const types::Object& object = scene.geometry->objects[part.object];
        box.add(types::getExtent(scene.geometry->meshes[static_cast<size_t>(object.mesh)], object.world_from_object));
    }
    return box;
}

void addTriangles(const scene::Scene& scene, size_t node, std::vector<std::array<glm::dvec3, 3>>& triangles) {
    for (const scene::Part& part : scene::getParts(scene, static_cast<int>(node))) {
        const types::Object& object = scene.geometry->objects[part.object];
        const types::Mesh& mesh = scene.geometry->meshes[static_cast<size_t>(object.mesh)];
        const auto corner = [&](size_t i) {
            return glm::dvec3(object.world_from_object * glm::dvec4(mesh.positions[mesh.indices[i]], 1));
        };
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
            triangles.push_back({corner(i), corner(i + 1), corner(i + 2)});
    }
}

/** Returns the triangles of all nodes that match a pattern. */
std::vector<std::array<glm::dvec3, 3>> findGround(const scene::Scene& scene, const std::string& pattern) {
    std::vector<std::array<glm::dvec3, 3>> triangles;
    for (size_t node = 0; node < scene.nodes.size(); ++node)
        if (matches(pattern, scene.nodes[node].name)) addTriangles(scene, node, triangles);
    return triangles;
}

bool anyMatches(const std::vector<std::string>& patterns, const std::string& name) {
    return std::ranges::any_of(patterns, [&](const std::string& each) { return matches(each, name); });
}

void addNode(const Sweep& sweep, const scene::Scene& scene, size_t node, SceneParts& parts) {
    const std::string& name = scene.nodes[node].name;
    const std::vector<scene::Part> objects = scene::getParts(scene, static_cast<int>(node));
    if (objects.empty()) return;
    for (const ObjectGroup& group : sweep.objects)
        if (anyMatches(group.avoid, name)) parts.boxes[name] = makeBox(scene, objects);
    const bool tilts = std::ranges::any_of(
        sweep.objects, [&](const ObjectGroup& group) { return group.tilts() && anyMatches(group.names, name); });
    parts.placeables[name] = makePlaceable(scene, objects, tilts);
}

template <class T>
void addBytes(types::Sha256& hash, const std::vector<T>& values) {
    hash.add({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

void addMaterial(types::Sha256& hash, const types::Material& material) {
    hash.add(fmt::format("{} {} {} {} {} {} {} {} {} {}\n", material.name, material.lambert_db, material.seabed,
                         material.reflection, material.roughness_slope.value_or(-1), material.mirror,
                         material.reflectivity, material.has_acoustics, material.normal_map, material.normal_scale));
    if (!material.matter.empty()) hash.add(fmt::format("matter {}\n", material.matter));
    if (const auto& shell = material.shell)
        hash.add(fmt::format("shell {} {} {} {} {} {} {} {} {}\n", shell->thickness, shell->density, shell->sound_speed,
                             shell->shear_speed, shell->loss, shell->has_air, shell->fill_density, shell->fill_speed,
                             shell->fill_loss));
    addBytes(hash, material.measured);
}

void addMap(types::Sha256& hash, const types::MappedMaterial& mapped) {
    const types::SurfaceMap& map = *mapped.map;
    hash.add(fmt::format("map {} {} {} {} {}\n", mapped.material, map.width, map.height, map.repeat_u, map.repeat_v));
    addBytes(hash, map.strengths);
    addBytes(hash, map.classes);
    addBytes(hash, map.materials);
}

using framework::child, framework::ConfigReader;
using types::Field;

YAML::Node absent() { return YAML::Node(YAML::NodeType::Undefined); }

/** The keys of a sweep; nested blocks are read later. */
struct SweepKeys {
    uint64_t seed = 1;
    YAML::Node scenes = absent(), poses = absent(), lines = absent(), settings = absent(), objects = absent(),
               classes = absent();
    Split split;
    output::PlainConfig picture;
    AnnotationConfig annotations;
    static void describe(auto& self, auto& visit) {
        visit({"seed", "1", "of all that is drawn at random"}, self.seed);
        visit({"scenes", "", "files, or blocks of file and set"}, self.scenes);
        visit({"poses", "", "of the vehicle: grid, random or trajectory"}, self.poses);
        visit({"lines", "", "of a side-scan, a run for each sample"}, self.lines);
        visit({"settings", "", "by task.property: lists of values, or what they are drawn from"}, self.settings);
        visit({"objects", "", "objects to place"}, self.objects);
        visit({"split", "", "shares of train, val and test"}, self.split);
        visit({"classes", "", "names of objects by class"}, self.classes);
        visit({"picture", "", "how samples look"}, self.picture);
        visit({"annotations", "", "what is annotated"}, self.annotations);
    }
};

struct PoseKeys {
    YAML::Node grid = absent(), random = absent(), trajectory = absent();
    static void describe(auto& self, auto& visit) {
        visit({"grid", "", "all combinations of coordinates"}, self.grid);
        visit({"random", "", "coordinates that are drawn"}, self.random);
        visit({"trajectory", "", "poses along a path"}, self.trajectory);
    }
    void check(types::Diagnostics& diagnostics) const {
        if (grid.IsDefined() + random.IsDefined() + trajectory.IsDefined() != 1)
            diagnostics.push_back({"", "must have one of grid, random and trajectory"});
    }
};

struct SceneKeys {
    std::string file, make;
    std::vector<uint32_t> seeds;
    std::optional<uint32_t> count;
    YAML::Node set = absent();
    static void describe(auto& self, auto& visit) {
        visit({"file", "", "scene, relative to the sweep; absent: that of the deployment"}, self.file);
        visit({"make", "", "instead: recipe of scenes, relative to the sweep"}, self.make);
        visit({"seeds", "", "of the recipe: a scene for each"}, self.seeds);
        visit({"count", "1", "instead: the seeds 1 to this number", 1, 100000}, self.count);
        visit({"set", "", "values by task.property"}, self.set);
    }
    void check(types::Diagnostics& diagnostics) const {
        if (!file.empty() && !make.empty()) diagnostics.push_back({"make", "is given with file; give one of them"});
        if (!seeds.empty() + count.has_value() != !make.empty())
            diagnostics.push_back({"", make.empty() ? "has seeds or count without make, the recipe that they are for"
                                                    : "must have one of seeds and count with make"});
    }
};

struct DrawnKeys {
    std::vector<double> uniform, normal;
    YAML::Node choice = absent();
    static void describe(auto& self, auto& visit) {
        visit({"uniform", "", "drawn uniformly: [min, max]", -1e12, 1e12}, self.uniform);
        visit({"normal", "", "drawn from a normal law: [mean, deviation]", -1e12, 1e12}, self.normal);
        visit({"choice", "", "one of a list"}, self.choice);
    }
    void check(types::Diagnostics& diagnostics) const {
        if (!uniform.empty() + !normal.empty() + choice.IsDefined() != 1)
            return diagnostics.push_back({"", "must have one of uniform, normal and choice"});
        Axis axis;
        axis.uniform = uniform, axis.normal = normal;
        if (!choice.IsDefined()) axis.check(diagnostics);
    }
};

std::string at(const std::string& path, size_t i) { return fmt::format("{}[{}]", path, i); }

Written written(const YAML::Node& node) { return {YAML::Dump(node), node.Mark().line + 1, node.Mark().column + 1}; }

class SweepReader {
public:
    explicit SweepReader(const std::filesystem::path& file) : folder_(file.parent_path()), reader_(file.string()) {
        sweep_.file = file.string();
        sweep_.text = framework::readFile(file, "a sweep");
        const std::vector<YAML::Node> documents = framework::parseYaml(sweep_.text, sweep_.file);
        if (documents.size() != 1 || documents[0].IsNull())
            throw types::ConfigError(sweep_.file, "", "must be one YAML document; a sweep needs poses");
        document_.reset(documents[0]);
    }

    Sweep sweep() {
        SweepKeys keys;
        reader_.setFallback(document_.Mark());
        reader_.read(document_, "", keys);
        sweep_.seed = keys.seed;
        sweep_.split = keys.split;
        sweep_.picture = keys.picture;
        sweep_.annotations = keys.annotations;
        readScenes(keys.scenes);
        readPoses(keys.poses);
        readLines(keys.lines);
        checkRangePicture();
        readSettings(keys.settings);
        readObjects(keys.objects);
        readClasses(keys.classes);
        if (!reader_.diagnostics().empty()) throw types::ConfigError(reader_.diagnostics());
        return std::move(sweep_);
    }

private:
    std::string inFolder(const std::string& file) const {
        return std::filesystem::path(file).is_absolute() ? file : (folder_ / file).string();
    }

    void readScenes(const YAML::Node& scenes) {
        if (!scenes.IsDefined() || !reader_.isSequence(scenes, "scenes", ", such as [a.glb, b.glb]")) return;
        if (scenes.size() == 0) reader_.report(scenes, "scenes", "is empty; without the key it is the deployment's");
        sweep_.scenes.clear();
        for (size_t i = 0; i < scenes.size(); ++i) readScene(scenes[i], at("scenes", i));
    }

    void readScene(const YAML::Node& node, const std::string& path) {
        SceneKeys keys;
        if (node.IsScalar())
            keys.file = node.Scalar();
        else
            reader_.read(node, path, keys);
        SceneChoice scene;
        scene.line = node.Mark().line + 1, scene.column = node.Mark().column + 1;
        for (const auto& [key, file] : {std::pair(&keys.file, &scene.file), std::pair(&keys.make, &scene.recipe)}) {
            if (key->empty()) continue;
            *file = inFolder(*key);
            if (!std::filesystem::is_regular_file(*file))
                reader_.report(node, path,
                               "is " + *key +
                                   (std::filesystem::is_directory(*file)
                                        ? ", a folder; must be a file"
                                        : "; there is no such file, which is relative to the sweep"));
        }
        if (keys.set.IsDefined() && reader_.isMap(keys.set, path + ".set", "{sonar.range: 20}"))
            for (const auto& entry : keys.set) scene.set.emplace_back(entry.first.Scalar(), written(entry.second));
        if (keys.make.empty()) return sweep_.scenes.push_back(std::move(scene));
        for (uint32_t i = 0; i < keys.count.value_or(0); ++i) keys.seeds.push_back(i + 1);
        for (const uint32_t seed : keys.seeds) {
            scene.seed = seed;
            sweep_.scenes.push_back(scene);
        }
    }

    void readPoses(const YAML::Node& poses) {
        PoseKeys keys;
        if (!poses.IsDefined())
            return reader_.report(document_, "poses", "is missing; give grid, random or trajectory");
        if (!reader_.read(poses, "poses", keys)) return;
        if (keys.grid.IsDefined()) sweep_.grid = readAxes(keys.grid, "poses.grid", {});
        if (keys.random.IsDefined()) readRandom(keys.random);
        if (!keys.trajectory.IsDefined()) return;
        sweep_.trajectory.emplace();
        reader_.read(keys.trajectory, "poses.trajectory", *sweep_.trajectory);
        const YAML::Mark place = keys.trajectory.Mark();
        sweep_.trajectory->line = place.line + 1, sweep_.trajectory->column = place.column + 1;
        sweep_.trajectory->file = inFolder(sweep_.trajectory->file);
    }

    void readLines(const YAML::Node& node) {
        const bool is_waterfall = sweep_.picture.shape == output::PlainShape::Waterfall;
        if (node.IsDefined() != is_waterfall)
            return reader_.report(node.IsDefined() ? node : child(child(document_, "picture"), "shape"),
                                  node.IsDefined() ? "lines" : "picture.shape",
                                  "`lines` and `picture: {shape: waterfall}` go together: give both or neither");
        if (!is_waterfall) return;
        LinesConfig& lines = sweep_.lines.emplace();
        lines.line = node.Mark().line + 1, lines.column = node.Mark().column + 1;
        if (!reader_.read(node, "lines", lines)) return;
        if (lines.speed.has_value() == sweep_.trajectory.has_value())
            reader_.report(node, "lines.speed",
                           sweep_.trajectory ? "is given with a trajectory, which has its own"
                                             : "is missing; give the speed of the vehicle straight ahead [m/s]");
        if (lines.motion && sweep_.trajectory)
            reader_.report(node, "lines.motion", "is given with a trajectory; give it as poses.trajectory.motion");
    }

    void checkRangePicture() {
        if (sweep_.picture.shape != output::PlainShape::Range) return;
        const YAML::Node shape = child(child(document_, "picture"), "shape"), asked = child(document_, "annotations");
        sweep_.picture_line = shape.Mark().line + 1, sweep_.picture_column = shape.Mark().column + 1;
        for (const auto& [key, is_asked] :
             {std::pair("shadows", sweep_.annotations.shadows), std::pair("ghosts", sweep_.annotations.ghosts)})
            if (is_asked)
                reader_.report(child(asked, key), std::string("annotations.") + key,
                               "is true; a range image shows the strongest return of each beam, no shadows and ghosts");
    }

    void readRandom(const YAML::Node& node) {
        sweep_.random = readAxes(node, "poses.random", {"count"});
        const YAML::Node count = child(node, "count");
        if (!count.IsDefined())
            return reader_.report(node, "poses.random", "has no count, the number of poses to draw");
        reader_.readValue(count, "poses.random.count", Field{"count", "1", "", 1, 1e8}, sweep_.random_count);
    }

    /** Reads coordinates of a grid, or of drawn poses, which have a total `count`. */
    PoseAxes readAxes(const YAML::Node& node, const std::string& path, std::vector<std::string> known) {
        const bool is_drawn = !known.empty();
        PoseAxes axes;
        if (!reader_.isMap(node, path, "{x: 0, y: 0, z: -5}")) return axes;
        PoseAxes::forEach(axes, [&](const char* name, const char* unit, Axis& axis) {
            known.push_back(name);
            const YAML::Node value = child(node, name);
            if (!value.IsDefined() || !readAxis(value, path + "." + name, unit, axis)) return;
            if (is_drawn && axis.stepCount() != 1)
                reader_.report(value, path + "." + name,
                               "has several values; for random poses give a number, {uniform: ...} or {normal: ...}");
            if (!is_drawn && axis.isDrawn())
                reader_.report(value, path + "." + name, "is drawn at random; a grid has a number, a list or steps");
        });
        reader_.refuseUnknown(node, path, known);
        return axes;
    }

    bool readAxis(const YAML::Node& node, const std::string& path, const char* unit, Axis& axis) {
        const Field field{"", unit, "", -1e7, 1e7};
        if (node.IsMap()) return reader_.read(node, path, axis);
        if (!node.IsSequence()) {
            axis.values.emplace_back();
            return reader_.readValue(node, path, field, axis.values.front());
        }
        if (node.size() == 0) return reader_.report(node, path, "is empty; a coordinate has at least one value"), false;
        return reader_.readValue(node, path, field, axis.values);
    }

    void readSettings(const YAML::Node& settings) {
        if (!settings.IsDefined() || !reader_.isMap(settings, "settings", "{sonar.range: [20, 30]}")) return;
        for (const auto& entry : settings) {
            const std::string name = entry.first.Scalar(), path = "settings." + name;
            if (entry.second.IsMap()) {
                sweep_.drawn.emplace_back().property = name;
                readDrawn(entry.second, path, sweep_.drawn.back());
            } else if (!entry.second.IsSequence()) {
                reader_.report(entry.second, path, "must be a list of values, or one of uniform, normal and choice");
            } else {
                sweep_.settings.emplace_back().property = name;
                readList(entry.second, path, sweep_.settings.back().values);
            }
        }
    }

    void readList(const YAML::Node& list, const std::string& path, std::vector<Written>& values) {
        if (list.size() == 0) reader_.report(list, path, "is empty; give at least one value");
        for (const YAML::Node& value : list) values.push_back(written(value));
    }

    void readDrawn(const YAML::Node& node, const std::string& path, DrawnSetting& drawn) {
        DrawnKeys keys;
        drawn.line = node.Mark().line + 1, drawn.column = node.Mark().column + 1;
        if (!reader_.read(node, path, keys)) return;
        drawn.law.uniform = keys.uniform, drawn.law.normal = keys.normal;
        if (keys.choice.IsDefined() && reader_.isSequence(keys.choice, path + ".choice", ", such as [20, 30]"))
            readList(keys.choice, path + ".choice", drawn.choice);
    }

    void readObjects(const YAML::Node& objects) {
        if (!objects.IsDefined()) return;
        reader_.readValue(objects, "objects", Field{"objects"}, sweep_.objects);
        for (size_t i = 0; i < sweep_.objects.size(); ++i) {
            const YAML::Node node = objects.IsSequence() ? objects[i] : objects;
            sweep_.objects[i].line = node.Mark().line + 1, sweep_.objects[i].column = node.Mark().column + 1;
        }
    }

    void readClasses(const YAML::Node& classes) {
        if (!classes.IsDefined() || !reader_.isMap(classes, "classes", "{pile: pile_*}")) return;
        for (const auto& entry : classes) {
            const std::string name = entry.first.Scalar(), path = "classes." + name;
            ClassRule& rule = sweep_.classes.emplace_back();
            rule.name = name;
            rule.line = entry.first.Mark().line + 1, rule.column = entry.first.Mark().column + 1;
            if (entry.second.IsScalar())
                rule.patterns = {entry.second.Scalar()};
            else
                reader_.readValue(entry.second, path, Field{"classes"}, rule.patterns);
        }
    }

    std::filesystem::path folder_;
    ConfigReader reader_;
    YAML::Node document_;
    Sweep sweep_;
};

}  // namespace

std::vector<std::string> describePoses(const Sweep& sweep, const SceneChoice& choice,
                                       const std::vector<std::vector<TimedPose>>& runs,
                                       const framework::Deployment& deployment, const scene::Scene& scene) {
    const uint64_t lines = sweep.lines ? sweep.lines->count : 1;
    const uint64_t at_most = std::clamp<uint64_t>(1'000'000 / lines, 1, 10'000);
    const auto varies = [&](const std::string& property) {
        const auto isPart = [&](const std::string& other) {
            return other == property || other.starts_with(property + ".");
        };
        return std::ranges::any_of(sweep.settings, isPart, &Setting::property) ||
               std::ranges::any_of(sweep.drawn, isPart, &DrawnSetting::property) ||
               std::ranges::any_of(choice.set, [&](const auto& set) { return isPart(set.first); });
    };
    Surroundings around;
    types::Mount mount;
    for (const auto& task : deployment.tasks()) {
        const auto* const sonar = dynamic_cast<const sonar::PingTask*>(task.get());
        if (sonar && sweep.objects.empty() && !varies(task->name() + ".range"))
            around.range = sonar->locatedConfig().range;
        const auto* const world = dynamic_cast<const scene::SceneTask*>(task.get());
        if (!world) continue;
        const scene::SceneConfig& config = *world->config;
        mount = config.mount;
        if (varies(task->name() + ".mount")) return {};
        if (!varies(task->name() + ".water_surface")) around.water_surface = config.water_surface;
        if (config.bathymetry || varies(task->name() + ".placement") || varies(task->name() + ".scale")) continue;
        const scene::Scene placed = config.placement ? scene::placed(scene, *config.placement) : scene;
        around.geometry = scene::withoutOmitted(placed, world->omitRules()).geometry;
    }
    const uint64_t count = countPoses(sweep, runs);
    around.step = (count + at_most - 1) / at_most;
    std::vector<glm::dvec3> positions;
    for (uint64_t i = 0; i < count; i += around.step) {
        types::Pose sonar;
        types::place(makeRun(sweep, runs, i).front().at, mount, sonar);
        positions.push_back(sonar.position);
    }
    return describeOddPoses(positions, around);
}

SceneParts getParts(const Sweep& sweep, const scene::Scene& scene) {
    SceneParts parts;
    if (sweep.objects.empty()) return parts;
    for (size_t node = 0; node < scene.nodes.size(); ++node) {
        addNode(sweep, scene, node, parts);
        parts.nodes.push_back(scene.nodes[node].name);
    }
    for (size_t i = 0; i < sweep.objects.size(); ++i) {
        const ObjectGroup& group = sweep.objects[i];
        const std::string path = fmt::format("objects[{}].", i);
        const auto isOfGroup = [&](const auto& each) { return anyMatches(group.names, each.first); };
        if (!group.ground || std::ranges::none_of(parts.placeables, isOfGroup)) continue;
        resolve(sweep, {*group.ground}, parts.nodes, path + "ground", group.line, group.column);
        auto& ground = parts.grounds[*group.ground] = findGround(scene, *group.ground);
        if (ground.empty())
            throw types::ConfigError({{path + "ground", "is " + *group.ground + ", which has no surface to stand on",
                                       sweep.file, group.line, group.column}});
    }
    return parts;
}

std::vector<Lineage> lineages(const scene::Scene& scene) {
    std::vector<Lineage> all;
    for (size_t i = 0; i < scene.geometry->objects.size(); ++i) {
        Lineage& names = all.emplace_back(Lineage{scene.geometry->objects[i].name});
        for (int node = scene.object_nodes[i]; node >= 0; node = scene.nodes[static_cast<size_t>(node)].parent)
            if (scene.nodes[static_cast<size_t>(node)].name != names.back())
                names.push_back(scene.nodes[static_cast<size_t>(node)].name);
    }
    return all;
}

std::string computeDigest(const types::Geometry& geometry) {
    types::Sha256 hash;
    for (const types::Mesh& mesh : geometry.meshes) {
        addBytes(hash, mesh.positions);
        addBytes(hash, mesh.normals);
        addBytes(hash, mesh.tangents);
        addBytes(hash, mesh.uvs);
        addBytes(hash, mesh.indices);
        for (const types::MappedMaterial& mapped : mesh.maps) addMap(hash, mapped);
        addBytes(hash, mesh.map_uvs);
        for (const types::Cluster& cluster : mesh.clusters)
            hash.add(fmt::format("{} {} {}\n", cluster.first_index, cluster.index_count, cluster.material));
    }
    for (const types::Object& object : geometry.objects) {
        hash.add(fmt::format("{}\n{}\n", object.name, object.mesh));
        hash.add({reinterpret_cast<const char*>(&object.world_from_object), sizeof object.world_from_object});
    }
    for (const types::Material& material : geometry.materials) addMaterial(hash, material);
    for (const types::NormalMap& map : geometry.normal_maps) {
        hash.add(fmt::format("{} {} {} {}\n", map.width, map.height, map.repeat_u, map.repeat_v));
        addBytes(hash, map.rgb);
    }
    return hash.hex();
}

Sweep readSweep(const std::filesystem::path& file) { return SweepReader(file).sweep(); }

}  // namespace insonify::dataset
