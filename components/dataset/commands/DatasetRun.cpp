#include "components/dataset/commands/DatasetRun.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <set>
#include <stdexcept>
#include <utility>

#include "components/console/Json.hpp"
#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Json.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/framework/config/YamlText.hpp"
#include "components/loader/ComponentLibrary.hpp"
#include "components/pose/Trajectory.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Sha256.hpp"

namespace insonify::dataset {
namespace {

namespace fs = std::filesystem;

/** Makes a folder among the files of all users, unless it exists. Throws types::ConfigError if another user owns it or
 *  may write to it: that user's scenes would become part of a data set. */
fs::path ownFolder(const fs::path& path) {
    mkdir(path.c_str(), S_IRWXU);
    struct stat status {};
    const bool is_own = lstat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == geteuid() &&
                        (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
    if (is_own) return path;
    throw types::ConfigError(path.string(), "",
                             "is not a folder that only this user may write to; HOME or XDG_CACHE_HOME names another "
                             "cache of made scenes");
}

/** Returns the folder of made scenes: by the XDG base directory specification, or the folder of temporary files. */
fs::path cacheFolder() {
    const auto getValue = [](const char* name) { return fs::path(std::getenv(name) ? std::getenv(name) : ""); };
    fs::path base = getValue("XDG_CACHE_HOME");
    if (!base.is_absolute() && getValue("HOME").is_absolute()) base = getValue("HOME") / ".cache";
    if (!base.is_absolute()) base = ownFolder(fs::temp_directory_path() / fmt::format("insonify-{}", geteuid()));
    return base / "insonify" / "scenes";
}

std::string generatorDigest() {
    std::string digest;
    loader::load("worlds").entry<void(std::string&)>("insonify_generator_digest")(digest);
    return digest;
}

std::string getOrigin(const SceneChoice& scene, const std::string& generator) {
    return fmt::format("recipe {} seed {} generator {}\n", types::sha256OfFile(scene.recipe), scene.seed, generator);
}

/** Returns the file of a scene, which is made if it does not exist. It is renamed to its final name when complete,
 *  because other processes may make it too. */
std::string madeFile(const SceneChoice& scene, const std::string& generator) {
    const fs::path folder = cacheFolder() / types::sha256(getOrigin(scene, generator)).substr(0, 32);
    const std::string stem = fmt::format("{}_{}", fs::path(scene.recipe).stem().string(), scene.seed);
    const fs::path file = folder / (stem + ".glb"), passing = folder / fmt::format("{}.{}.glb", stem, getpid());
    if (fs::is_regular_file(file)) return file;
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw types::ConfigError(
            folder.string(), "",
            fmt::format("cannot be made: {}; XDG_CACHE_HOME names another cache", error.message()));
    loader::load("worlds").entry<void(const std::vector<std::string>&)>("insonify_make_scene")(
        {"--recipe=" + scene.recipe, fmt::format("--seed={}", scene.seed), "--out=" + passing.string(), "--quiet"});
    fs::rename(passing, file);
    return file;
}

bool hasRecipe(const SceneChoice& scene) { return !scene.recipe.empty(); }

}  // namespace

Sweep withMadeScenes(Sweep sweep) {
    if (std::ranges::none_of(sweep.scenes, hasRecipe)) return sweep;
    const std::string generator = generatorDigest();
    for (SceneChoice& scene : sweep.scenes)
        if (hasRecipe(scene)) scene.file = madeFile(scene, generator);
    return sweep;
}

std::string describeOrigins(const Sweep& sweep) {
    if (std::ranges::none_of(sweep.scenes, hasRecipe)) return "";
    const std::string generator = generatorDigest();
    std::string text;
    for (const SceneChoice& scene : sweep.scenes)
        if (hasRecipe(scene)) text += getOrigin(scene, generator);
    return text;
}

namespace fs = std::filesystem;
namespace {

using framework::child, framework::splitPort;

constexpr const char* scene_type = "scene::SceneTask";
constexpr uint64_t max_poses = 1'000'000;  ///< Max poses of a trajectory.
constexpr uint32_t max_beams_per_line = 2;

constexpr const char* no_budget =
    "budget_ms lets the speed of the machine decide how samples are rendered, which must not depend on it; "
    "give rows or target_error";

/** Returns a text as a value in YAML. */
std::string quoted(const std::string& text) { return console::Json(text).dump(); }

/** Returns the trajectory of a sweep. A file that does not exist is an error at its place in the sweep. */
pose::Trajectory makeTrajectory(const Sweep& sweep) {
    const TrajectoryPoses& asked = *sweep.trajectory;
    try {
        return pose::Trajectory::fromFile(asked.file, false, asked.times, asked.world_frame);
    } catch (const types::ConfigError& error) {
        if (std::error_code none; fs::exists(asked.file, none)) throw;
        throw types::ConfigError({{"poses.trajectory.file", error.what(), sweep.file, asked.line, asked.column}});
    }
}

Sweep seeded(Sweep sweep, std::optional<uint64_t> seed) {
    if (seed.value_or(0) != 0) sweep.seed = *seed;
    return sweep;
}

/** Returns the poses of each sample along a trajectory. */
std::vector<std::vector<TimedPose>> getRuns(const Sweep& sweep) {
    std::vector<std::vector<TimedPose>> runs;
    if (!sweep.trajectory) return runs;
    const TrajectoryPoses& asked = *sweep.trajectory;
    const pose::Trajectory trajectory = makeTrajectory(sweep);
    const double first = trajectory.stamps().front().time, last = trajectory.stamps().back().time;
    const double from = asked.from.value_or(std::max(first, 0.0)), to = asked.to.value_or(last);
    const double length = to - from - (sweep.lines ? sweep.lines->duration() : 0);  // where samples begin
    for (const auto& [key, time] : {std::pair("from", from), std::pair("to", to)})
        if (time < first || time > last)
            throw types::ConfigError(
                {{std::string("poses.trajectory.") + key,
                  fmt::format("is {:g} s; the trajectory is from {:g} to {:g} s", time, first, last), sweep.file,
                  asked.line, asked.column}});
    if (length < 0)
        throw types::ConfigError({{"lines",
                                   fmt::format("take {:g} s; the trajectory from {:g} to {:g} s is shorter",
                                               sweep.lines->duration(), from, to),
                                   sweep.file, sweep.lines->line, sweep.lines->column}});
    const uint64_t lines = sweep.lines ? sweep.lines->count : 1;
    const auto count = asked.count ? uint64_t{*asked.count} : static_cast<uint64_t>(length / *asked.period + 1e-9) + 1;
    if (count > max_poses / lines)
        throw types::ConfigError(sweep.file, "poses.trajectory.period",
                                 fmt::format("makes {} poses; at most {}", count * lines, max_poses));
    const auto motion = asked.motion ? std::optional<pose::SeaMotion>(*asked.motion) : std::nullopt;
    for (uint64_t i = 0; i < count; ++i) {
        const double step = asked.count ? (count == 1 ? 0 : length / static_cast<double>(count - 1)) : *asked.period;
        std::vector<TimedPose>& run = runs.emplace_back();
        for (uint64_t line = 0; line < lines; ++line) {
            const double time = from + step * static_cast<double>(i) +
                                (sweep.lines ? sweep.lines->period * static_cast<double>(line) : 0);
            run.push_back({time, trajectory.at(std::min(time, last))});
            if (motion) motion->move(time, run.back().at);
        }
    }
    return runs;
}

/** Returns whether files of a task affect what a sonar measures. */
bool decides(const framework::TaskSpec& task) {
    static const std::set<std::string> others = {"dds", "device", "logger", "output", "replay", "viewer"};
    return !others.contains(task.type.substr(0, task.type.find("::")));
}

/** Adds every text in a block that names a file, relative to a folder, with the hash of its bytes. */
void addFiles(const YAML::Node& node, const fs::path& folder, std::string& text) {
    if (!node.IsDefined()) return;
    if (node.IsSequence())
        for (const YAML::Node& each : node) addFiles(each, folder, text);
    if (node.IsMap())
        for (const auto& entry : node) addFiles(entry.second, folder, text);
    std::error_code ignored;
    if (node.IsScalar() && !node.Scalar().empty() && fs::is_regular_file(folder / node.Scalar(), ignored))
        text += fmt::format("file {}\n", types::sha256OfFile(folder / node.Scalar()));
}

/** Adds the files that a sweep names for properties, relative to the folder of the deployment, and its scenes. */
void addFiles(const Sweep& sweep, const fs::path& folder, std::string& text) {
    for (const Setting& setting : sweep.settings)
        for (const Written& value : setting.values) addFiles(framework::parseValue(value.yaml), folder, text);
    for (const DrawnSetting& drawn : sweep.drawn)
        for (const Written& value : drawn.choice) addFiles(framework::parseValue(value.yaml), folder, text);
    for (const SceneChoice& scene : sweep.scenes) {
        if (!scene.file.empty()) text += fmt::format("file {}\n", types::sha256OfFile(scene.file));
        for (const auto& [property, value] : scene.set) addFiles(framework::parseValue(value.yaml), folder, text);
    }
}

/** Returns whether a task is a receiver whose output is codes. */
bool sendsCodes(const std::unique_ptr<framework::TaskContext>& task) {
    return std::ranges::any_of(task->properties(), [](const framework::PropertiesBase* properties) {
        const auto values = properties->values();
        const auto output = values.find("output");
        const std::string* const name = output == values.end() ? nullptr : std::get_if<std::string>(&output->second);
        return name && *name == "code";
    });
}

YAML::Node findBudget(const framework::TaskSpec& task) { return child(child(task.properties, "quality"), "budget_ms"); }

/** Returns the only name; throws if there are several or none. */
const std::string& findOnly(const std::vector<std::string>& names, const std::string& file, const char* what) {
    if (names.size() == 1) return names.front();
    throw types::ConfigError(file, "connections",
                             fmt::format("has several {}: {}; a data set is of one", what, fmt::join(names, ", ")));
}

}  // namespace

DatasetRun::DatasetRun(const std::string& deployment, const std::string& sweep, Format format, Changes changes)
    : deployment_(deployer::deploymentIn(deployment)),
      changes_(std::move(changes)),
      sweep_(withMadeScenes(seeded(readSweep(deployer::exampleAt(sweep)), changes_.seed))),
      format_(format),
      spec_(loaded()) {
    framework::Registry registry = deployer::coreTasks();
    framework::Deployment checked(spec_, registry);  // throws the errors of the unchanged deployment
    refuseBudgets();
    checkAssignments();
    auto runs = getRuns(sweep_);
    readScenes(checked, runs);
    std::vector<SceneParts> parts;
    std::vector<std::string> objects, nodes;
    for (const SceneFile& scene : scenes_) {
        parts.push_back(scene.parts);
        for (const Lineage& names : scene.objects) {
            objects.push_back(names.front());
            nodes.insert(nodes.end(), names.begin() + 1, names.end());
        }
    }
    samples_.emplace(sweep_, std::move(runs), std::move(parts));
    classes_.emplace(sweep_, objects, nodes);
    std::ranges::copy(classes_->notices(), std::back_inserter(warnings_));
    if (sweep_.picture.scale != output::BinScale::Code && std::ranges::any_of(checked.tasks(), sendsCodes))
        warnings_.push_back("picture: shows the codes of the receiver as intensities; give scale: code, and code_bits");
    for (const SceneFile& scene : scenes_) instances_.emplace_back(*classes_, scene.objects);
    selection_ =
        changes_.count ? Selection(samples_->count(), *changes_.count, sweep_.seed) : Selection(samples_->count());
    if (const std::string empty = describeEmptyParts(sweep_, selection_, *samples_); !empty.empty())
        warnings_.push_back(empty);
    checkDrawn();
    computeDigests();
}

Title DatasetRun::title(const std::string& sweep) const {
    bool draws_poses = false;
    if (sweep_.random)
        PoseAxes::forEach(*sweep_.random,
                          [&](const char*, const char*, const Axis& axis) { draws_poses |= axis.isDrawn(); });
    const Split& split = sweep_.split;
    const bool is_split = (split.train > 0) + (split.val > 0) + (split.test > 0) > 1;
    return {INSONIFY_VERSION,
            fs::path(deployment_).filename(),
            fs::path(sweep).filename(),
            origin_,
            format_,
            sweep_.trajectory.has_value() && !sweep_.lines,
            is_split && !draws_poses,
            sweep_.scenes.size(),
            classes_->names(),
            {{sweep_.seed, samples_->count(), changes_.count, digest_}}};
}

framework::DeploymentSpec DatasetRun::loaded() const {
    framework::DeploymentSpec spec = framework::DeploymentSpec::load(deployment_);
    for (const std::string& assignment : changes_.set) spec.set(assignment);
    const bool has_all =
        std::ranges::all_of(sweep_.scenes, [](const SceneChoice& choice) { return !choice.file.empty(); });
    std::vector<std::string> absent;  // scene tasks whose file is not there, and not needed
    for (const framework::TaskSpec& task : spec.tasks) {
        const YAML::Node own = child(task.properties, "file");
        if (task.type == scene_type && has_all && own.IsScalar() &&
            !fs::exists(fs::path(deployment_).parent_path() / own.Scalar()))
            absent.push_back(task.name);
    }
    for (const std::string& task : absent)
        spec.set(task + ".file=" + quoted(fs::absolute(sweep_.scenes.front().file).string()));
    return spec;
}

std::vector<std::string> DatasetRun::tasksOfType(const std::string& type) const {
    std::vector<std::string> names;
    for (const framework::TaskSpec& task : spec_.tasks)
        if (task.type == type) names.push_back(task.name);
    return names;
}

/** Rejects time budgets: samples must not depend on the speed of the machine. */
void DatasetRun::refuseBudgets() const {
    framework::ConfigReader reader(spec_.file, spec_.origins);
    for (const framework::TaskSpec& task : spec_.tasks) {
        const YAML::Node budget = findBudget(task);
        if (budget.IsDefined()) reader.report(budget, task.path() + ".properties.quality.budget_ms", no_budget);
    }
    if (!reader.diagnostics().empty()) throw types::ConfigError(reader.diagnostics());
}

void DatasetRun::checkAssignments() const {
    for (const Setting& setting : sweep_.settings)
        for (size_t i = 0; i < setting.values.size(); ++i)
            checkAssignment(fmt::format("settings.{}[{}]", setting.property, i), setting.property, setting.values[i]);
    for (size_t i = 0; i < sweep_.scenes.size(); ++i)
        for (const auto& [property, value] : sweep_.scenes[i].set)
            checkAssignment(fmt::format("scenes[{}].set.{}", i, property), property, value);
}

/** Checks every value of a choice. Of a law it checks the min and max that samples draw, and the first value, which may
 *  have decimals when min and max have none. */
void DatasetRun::checkDrawn() const {
    for (size_t i = 0; i < sweep_.drawn.size(); ++i) {
        const DrawnSetting& drawn = sweep_.drawn[i];
        const std::string path = "settings." + drawn.property;
        for (size_t k = 0; k < drawn.choice.size(); ++k)
            checkAssignment(fmt::format("{}.choice[{}]", path, k), drawn.property, drawn.choice[k]);
        if (!drawn.choice.empty()) continue;
        const double first = drawn.law.draw(word(sweep_, selection_[0], i));
        double minimum = first, maximum = first;
        for (uint64_t k = 1; k < selection_.size(); ++k) {
            const double value = drawn.law.draw(word(sweep_, selection_[k], i));
            minimum = std::min(minimum, value), maximum = std::max(maximum, value);
        }
        for (const double value : {first, minimum, maximum}) try {
                checkAssignment(path, drawn.property, {fmt::format("{}", value), drawn.line, drawn.column});
            } catch (const types::ConfigError& error) {
                types::Diagnostics diagnostics = error.diagnostics();
                for (types::Diagnostic& each : diagnostics)
                    if (each.kind == types::Diagnostic::Kind::NotWhole) each.message += "; use choice";
                throw types::ConfigError(diagnostics);
            }
    }
}

/** Throws the errors of a property's value, with its place in the sweep. */
void DatasetRun::checkAssignment(const std::string& path, const std::string& property, const Written& value) const {
    framework::Registry registry = deployer::coreTasks();
    framework::DeploymentSpec spec = loaded();
    spec.set(property + "=" + value.yaml);
    types::Diagnostics diagnostics;
    const auto refuse = [&](const std::string& why, types::Diagnostic::Kind kind = types::Diagnostic::Kind::Value) {
        diagnostics.push_back({path, why, sweep_.file, value.line, value.column, kind});
    };
    for (const framework::TaskSpec& each : spec.tasks) {
        if (each.type == scene_type && property == each.name + ".file")
            refuse("names the file of " + each.name + ", which sets the objects of the scene; name it under scenes");
        if (findBudget(each).IsDefined()) refuse(no_budget);
    }
    if (!diagnostics.empty()) throw types::ConfigError(diagnostics);
    const auto [task, name] = splitPort(property);
    const std::string full = fmt::format("tasks.{}.properties.{}", task, name), block = full.substr(0, full.rfind('.'));
    if (spec.task(task)) spec = deployer::restrictedTo(std::move(spec), {task});
    try {
        const framework::Deployment deployment(std::move(spec), registry);
    } catch (const types::ConfigError& error) {
        for (const types::Diagnostic& each : error.diagnostics())
            if (each.file == framework::set_origin || each.path.starts_with(block))
                refuse(each.path + ": " + each.message, each.kind);
    }
    if (!diagnostics.empty()) throw types::ConfigError(diagnostics);
}

DatasetRun::SceneFile DatasetRun::readScene(const std::string& file, const scene::Scene& scene) const {
    SceneFile read{file.empty() ? "bathymetry" : fs::path(file).filename().string(),
                   getParts(sweep_, scene),
                   {},
                   dataset::computeDigest(*scene.geometry)};
    read.objects = lineages(scene);
    return read;
}

void DatasetRun::readScenes(const framework::Deployment& deployment, const std::vector<std::vector<TimedPose>>& runs) {
    constexpr size_t shown = 5;  // scenes with odd poses
    std::set<std::string> reported;
    size_t odd = 0;
    const std::vector<std::string> tasks = tasksOfType(scene_type);
    if (tasks.empty()) throw types::ConfigError(spec_.file, "tasks", "have no scene; a data set needs one");
    for (const SceneChoice& choice : sweep_.scenes) {
        const YAML::Node own = child(spec_.task(tasks.front())->properties, "file");
        std::string file = choice.file;
        if (file.empty() && own.IsDefined()) file = (fs::path(deployment_).parent_path() / own.Scalar()).string();
        scene::Scene scene;
        scene.geometry = std::make_shared<const types::Geometry>();
        if (!file.empty()) scene = scene::readScene(file);  // otherwise there is only the floor of a survey
        scenes_.push_back(readScene(file, scene));
        if (odd >= shown) continue;
        const size_t before = reported.size();
        for (const std::string& text : describePoses(sweep_, choice, runs, deployment, scene))
            if (reported.insert(text).second)
                warnings_.push_back(sweep_.scenes.size() > 1 ? scenes_.back().name + ": " + text : text);
        odd += reported.size() > before ? 1 : 0;
    }
}

void DatasetRun::computeDigests() {
    const fs::path folder = fs::path(deployment_).parent_path();
    const std::string seed = fmt::format("seed {}\n", sweep_.seed);
    const std::string head = fmt::format("insonify {}\n{}\ndeployment {}\nsweep {}\n", INSONIFY_VERSION,
                                         types::EnumNames<Format>::names[static_cast<size_t>(format_)],
                                         types::sha256(spec_.text), types::sha256(sweep_.text));
    std::string text = fmt::format("set {}\n", console::Json(changes_.set).dump());
    for (const framework::TaskSpec& task : spec_.tasks) {
        if (decides(task)) addFiles(task.properties, folder, text);
        for (const std::string& file : task.property_files.files)
            text += fmt::format("file {}\n", types::sha256OfFile(folder / file));
    }
    addFiles(sweep_, folder, text);
    text += describeOrigins(sweep_);
    for (const SceneFile& scene : scenes_) text += fmt::format("scene {} {}\n", scene.name, scene.digest);
    if (sweep_.trajectory) text += fmt::format("trajectory {}\n", types::sha256OfFile(sweep_.trajectory->file));
    origin_ = types::sha256(head + text);
    digest_ = types::sha256(head + seed + text + (changes_.count ? fmt::format("count {}\n", *changes_.count) : ""));
}

std::vector<std::string> DatasetRun::makeOverrides(const Sample& sample) const {
    std::vector<std::string> all = changes_.set;
    const SceneChoice& choice = sweep_.scenes[sample.scene];
    if (!choice.file.empty())
        for (const std::string& task : tasksOfType(scene_type))
            all.push_back(task + ".file=" + quoted(fs::absolute(choice.file).string()));
    std::ranges::copy(deployer::pinnedRays(spec_), std::back_inserter(all));
    for (const auto& [property, value] : choice.set) all.push_back(property + "=" + value.yaml);
    for (const auto& [property, value] : sample.settings) all.push_back(property + "=" + value);
    if (std::ranges::any_of(sample.objects, [](const PlacedObject& object) { return object.scale != 1; }))
        for (const std::string& task : tasksOfType(scene_type))
            all.push_back(task + ".scale=" + getScale(task, sample));
    return all;
}

/** Returns the scales of a scene's nodes from its task, with those of a sample's objects. */
std::string DatasetRun::getScale(const std::string& task, const Sample& sample) const {
    console::Json scales = console::Json::object();
    const YAML::Node own = child(spec_.task(task)->properties, "scale");
    if (own.IsMap())
        for (const auto& entry : own) scales[entry.first.Scalar()] = entry.second.as<double>();
    for (const PlacedObject& object : sample.objects) scales[object.name] = object.scale;
    return scales.dump();
}

/** Returns the errors of a sample whose values do not fit together, with their places in the sweep. */
types::ConfigError DatasetRun::placed(types::Diagnostics diagnostics, const Sample& sample) const {
    std::string values;
    for (const auto& [property, value] : sample.settings) values += fmt::format("; {} is {}", property, value);
    const auto place = [&](types::Diagnostic& each, const std::string& property, int line, int column) {
        const auto [task, name] = splitPort(property);
        if (each.file == framework::set_origin && each.path == fmt::format("tasks.{}.properties.{}", task, name))
            each = {"settings." + property, each.message + values, sweep_.file, line, column};
    };
    for (types::Diagnostic& each : diagnostics) {
        for (const Setting& setting : sweep_.settings)
            for (const Written& value : setting.values)
                if (std::ranges::count(sample.settings, std::pair(setting.property, value.yaml)) > 0)
                    place(each, setting.property, value.line, value.column);
        for (const DrawnSetting& drawn : sweep_.drawn) place(each, drawn.property, drawn.line, drawn.column);
    }
    return types::ConfigError(std::move(diagnostics));
}

/** Returns the values in which overrides differ from those before, for Simulation::set(); none where they differ in
 *  anything else than single values. A block would keep the fields that it does not name. */
std::optional<std::map<std::string, std::string>> DatasetRun::findChanges(const std::vector<std::string>& after) const {
    if (after.size() != overrides_.size()) return {};
    std::map<std::string, std::string> changes;
    for (size_t i = 0; i < after.size(); ++i) {
        if (after[i] == overrides_[i]) continue;
        const size_t end = after[i].find('=');
        const std::string property = after[i].substr(0, end), value = after[i].substr(end + 1);
        const YAML::Node node = framework::parseValue(value);
        const auto replaces = [&](const std::string& later) {  // the same property, or a block around it
            const std::string other = later.substr(0, later.find('='));
            return other == property || property.starts_with(other + ".");
        };
        if (!overrides_[i].starts_with(property + "=") || !node.IsScalar() ||
            !framework::parseValue(overrides_[i].substr(end + 1)).IsScalar() ||
            std::any_of(after.begin() + static_cast<std::ptrdiff_t>(i) + 1, after.end(), replaces))
            return {};
        changes[property] = value;
    }
    return changes;
}

/** Sets properties of the current simulations. Returns false where they need to be made anew. */
bool DatasetRun::change(const std::optional<std::map<std::string, std::string>>& changes) {
    if (!changes) return false;
    try {
        simulation_->set(*changes);
        if (hiding_) hiding_->set(*changes);
        return true;
    } catch (const std::exception&) {  // a running task refuses it; what is wrong, the new simulation reports
        return false;
    }
}

/** Makes the simulation of a sample, or changes the current one. Keeps the previous one so that they share the scene,
 *  trees, and derived data of meshes. */
void DatasetRun::simulate(const Sample& sample) {
    deployer::SimulationOptions options;
    options.overrides = makeOverrides(sample);
    options.truth = true;
    options.objects = samples_->getObjects(sample.scene);
    if (simulation_ && sample.scene == scene_ && change(findChanges(options.overrides))) {
        overrides_ = options.overrides;
        return;
    }
    try {
        before_ = std::exchange(simulation_, std::make_unique<deployer::Simulation>(deployment_, options));
        hiding_.reset();
        if (sweep_.annotations.shadows) hiding_ = std::make_unique<deployer::Simulation>(deployment_, options);
        if (hiding_) hiding_->setHideable(getHiders(sample.scene));
    } catch (const types::ConfigError& error) {
        throw placed(error.diagnostics(), sample);
    }
    overrides_ = options.overrides, scene_ = sample.scene;
}

/** Collects the warnings of a new simulation, whose plans have theirs from the first ping on. */
void DatasetRun::collectWarnings() {
    for (const types::Notice& notice : simulation_->notices())
        if (notice.kind == types::Notice::Kind::Warning && warned_.insert(notice.text).second)
            warnings_.push_back(notice.text);
}

/** Returns the objects of a scene that are of an instance whose shadow is annotated. */
std::vector<uint32_t> DatasetRun::getHiders(size_t scene) const {
    const Instances& instances = instances_[scene];
    std::vector<uint32_t> objects;
    for (size_t i = 0; i < instances.objectCount(); ++i)
        if (instances.shadow(instances.of(static_cast<int32_t>(i))) != 0) objects.push_back(static_cast<uint32_t>(i));
    return objects;
}

std::map<std::string, types::Pose> DatasetRun::placeObjects(const Sample& sample) const {
    std::map<std::string, types::Pose> at;
    for (const PlacedObject& object : sample.objects) at[deployer::Simulation::objectPort(object.name)] = object.at;
    return at;
}

/** Returns the instance whose shadow each bin of a sample is: lines that show an instance, and the lines next to them,
 *  are rendered again without it. */
std::vector<int32_t> DatasetRun::findHiders(const Sample& sample, const std::string& vehicle, const Run& run) {
    constexpr size_t margin = 2;  // lines before and behind those with an echo
    const Instances& instances = instances_[sample.scene];
    std::map<int32_t, std::vector<bool>> shown;  // lines by instance
    for (size_t line = 0; line < run.size(); ++line)
        for (const int32_t object : run.truths()[line]->object)
            if (object >= 0 && static_cast<size_t>(object) < instances.objectCount() &&
                instances.shadow(instances.of(object)) != 0) {
                std::vector<bool>& lines = shown[instances.of(object)];
                lines.resize(run.size());
                lines[line] = true;
            }
    std::map<std::string, types::Pose> at = placeObjects(sample);
    const size_t bins = run.truths()[0]->object.size();
    std::vector<int32_t> hiders(run.size() * bins, types::SonarTruth::no_object);
    for (const auto& [instance, lines] : shown) {
        const std::vector<int32_t> parts = instances.parts(instance);
        hiding_->hide({parts.begin(), parts.end()});
        hiding_->reset(sample.seed);
        const double start = hiding_->time();
        for (size_t line = 0; line < run.size(); ++line) {
            const auto first = lines.begin() + static_cast<ptrdiff_t>(line > margin ? line - margin : 0);
            const auto last = lines.begin() + static_cast<ptrdiff_t>(std::min<size_t>(run.size(), line + margin + 1));
            if (std::find(first, last, true) == last) continue;
            at[vehicle] = sample.run[line].at;
            const deployer::SteppedPing made = hiding_->step(at, start + sample.run[line].time).front();
            if (!made.truth) throw std::runtime_error(fmt::format("sample {} made no ping", sample.index));
            addShadow(*run.truths()[line], *made.truth, instance, std::span(hiders).subspan(line * bins, bins));
        }
    }
    return hiders;
}

void DatasetRun::make(uint64_t index, SampleFiles& files) {
    const Sample sample = samples_->at(index);
    simulate(sample);
    std::vector<std::string> vehicles = simulation_->poses();
    std::map<std::string, types::Pose> at = placeObjects(sample);
    for (const auto& [port, pose] : at) std::erase(vehicles, port);
    const std::string vehicle = findOnly(vehicles, deployment_, "vehicles");
    findOnly(simulation_->pings(), deployment_, "pings");
    const bool is_3d = simulation_->hasRangeImages(0);
    if (sweep_.picture.shape == output::PlainShape::Range && !is_3d)
        throw types::ConfigError(
            {{"picture.shape", "is range, a picture of 3-D sonars; the sonar of " + deployment_ + " is not 3-D",
              sweep_.file, sweep_.picture_line, sweep_.picture_column}});
    simulation_->reset(sample.seed);
    const double start = simulation_->time();
    Run run;
    deployer::SteppedPing made;
    for (const auto& [time, pose] : sample.run) {
        at[vehicle] = pose;
        made = simulation_->step(at, start + time).front();
        if (!made.ping || !made.truth || (is_3d && (!made.range_image || !made.range_truth)))
            throw std::runtime_error(fmt::format("sample {} made no ping", index));
        if (sweep_.lines && made.ping->beam_count > max_beams_per_line)
            throw types::ConfigError(
                {{"lines",
                  fmt::format("are of side-scans, whose pings have one or two beams; the pings of {} have {}",
                              deployment_, made.ping->beam_count),
                  sweep_.file, sweep_.lines->line, sweep_.lines->column}});
        run.add(made.ping, made.truth);
        if (before_ || warned_.empty()) collectWarnings();
        before_.reset();
    }
    std::vector<std::pair<std::string, Json>> settings;
    for (const auto& [property, yaml] : sample.settings)
        settings.emplace_back(property, deployer::toJson(framework::parseValue(yaml)));
    files.write({sample, run, instances_[sample.scene], scenes_[sample.scene].name, std::move(settings),
                 made.range_image, made.range_truth,
                 hiding_ ? findHiders(sample, vehicle, run) : std::vector<int32_t>()});
}

}  // namespace insonify::dataset
