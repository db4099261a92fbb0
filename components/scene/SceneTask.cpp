#include "components/scene/SceneTask.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <variant>

#include "components/framework/Graph.hpp"
#include "components/framework/execution/Activity.hpp"
#include "components/scene/Acoustics.hpp"
#include "components/scene/Drawings.hpp"
#include "types/Time.hpp"
#include "types/geometry/Extent.hpp"
#include "types/geometry/WorldFrame.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::scene {
namespace {

std::string unknown(const Scene& scene, const std::string& node) {
    constexpr size_t shown = 50;
    std::vector<std::string> names;
    for (const Node& one : scene.nodes) names.push_back(one.name);
    std::ranges::sort(names);
    const std::string near = types::didYouMean(node, names);
    const bool all = names.size() <= shown;
    return fmt::format("is {}, which is no node of the scene; {}may be {}{}", node, near,
                       fmt::join(names.begin(), names.begin() + static_cast<long>(std::min(shown, names.size())), ", "),
                       all ? "" : ", ...");
}

bool isFinite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/** Places the target on a node, or returns why it cannot be there. */
std::string attach(const Scene& scene, const TargetConfig& config, const std::vector<int>& moving,
                   PlacedTarget& target) {
    const int node = findNode(scene, config.attached_to);
    if (node < 0) return unknown(scene, config.attached_to);
    const glm::dvec3 offset = config.position.value_or(glm::dvec3(0));
    target.in_world = getPlace(scene, node, -1, offset);
    target.node = node;
    target.offset = offset;
    for (int body = node; body >= 0; body = scene.nodes[static_cast<size_t>(body)].parent)
        if (std::ranges::count(moving, body) > 0)
            target.carriers.push_back({body, getPlace(scene, node, body, offset)});
    const bool placed = isFinite(target.in_world) &&
                        std::ranges::all_of(target.carriers, [](const auto& one) { return isFinite(one.place); });
    return placed ? ""
                  : fmt::format("is {}, which is scaled to nothing and has no axes; omit position", config.attached_to);
}

/** Sets the place in the world of a place on the earth, or returns why it has none. */
std::string placeOnEarth(const types::Datum& place, const std::optional<types::Datum>& datum, glm::dvec3& in_world) {
    constexpr double farthest = 1e5;  // [m]
    if (!datum) return "needs the deployment's datum, the world's origin on the earth";
    try {
        in_world = types::Axes{types::WorldFrame::Enu}.rockFromWorld(eastNorthUp(*datum, place));
    } catch (const types::ConfigError& error) {
        return error.diagnostics().front().message;
    }
    const double distance = glm::length(in_world);
    if (distance <= farthest) return "";
    return fmt::format("is {:.0f} km from the datum {}; at most {:.0f}: are latitude and longitude exchanged?",
                       distance / 1e3, text(*datum), farthest / 1e3);
}

constexpr std::string_view time_ending = ".time";

constexpr const char* unusable =
    ": pose dropped: position and orientation must be finite, the quaternion of unit length";

/** Sets the sonar's velocities from the velocities of the body that carries it. */
void moveAlong(const types::Pose& body, const Mount& mount, types::Pose& sonar) {
    const glm::dvec3& turn = body.angular_velocity;
    sonar.velocity = body.velocity + glm::normalize(body.orientation) * glm::cross(turn, mount.position);
    sonar.angular_velocity = glm::inverse(mount.orientation()) * turn;
}

/** How fast a node's place changes: by the velocities of its pose, else by the pose before; 0 where neither is known.
 */
glm::dmat4 computeRate(const types::Pose& pose, const glm::dmat4& place, const std::optional<glm::dmat4>& before,
                       types::Time time_before) {
    glm::dmat4 rate(0);
    if (std::isfinite(glm::length(pose.velocity)) && std::isfinite(glm::length(pose.angular_velocity))) {
        const glm::dvec3 turn = pose.orientation * pose.angular_velocity;
        for (int axis = 0; axis < 3; ++axis) rate[axis] = glm::dvec4(glm::cross(turn, glm::dvec3(place[axis])), 0);
        rate[3] = glm::dvec4(pose.velocity, 0);
        return rate;
    }
    const double seconds = (pose.time - time_before).seconds();
    return before && seconds > 0 ? (place - *before) / seconds : rate;
}

}  // namespace

void TargetConfig::check(types::Diagnostics& diagnostics) const {
    if (name.empty()) diagnostics.push_back({"name", "is missing; give each target a name of its own"});
    if (!position && !geodetic && attached_to.empty())
        diagnostics.push_back({"position", "is missing; give the target's place, or geodetic, or attached_to"});
    if (geodetic && (position || !attached_to.empty()))
        diagnostics.push_back({"geodetic", std::string("is given, and ") + (position ? "position" : "attached_to") +
                                               " as well; give one"});
    if (!strength_db) diagnostics.push_back({"strength_db", "is missing; give the target strength [dB re 1 m^2]"});
}

void SceneConfig::check(types::Diagnostics& diagnostics) const {
    if (gazebo && !file.empty())
        diagnostics.push_back({"gazebo", "is given, and file as well; give one of both, which holds the models"});
    std::map<std::string, size_t> first;
    for (size_t i = 0; i < targets.size(); ++i)
        if (const auto [known, is_new] = first.try_emplace(targets[i].name, i); !is_new)
            diagnostics.push_back({fmt::format("targets[{}].name", i),
                                   fmt::format("is {}, which targets[{}] has; give each target a name of its own",
                                               targets[i].name, known->second)});
}

std::vector<PlacedTarget> placeTargets(const Scene& scene, const std::vector<TargetConfig>& targets,
                                       const std::vector<int>& moving, types::Diagnostics& diagnostics,
                                       const std::optional<types::Datum>& datum) {
    std::vector<PlacedTarget> all;
    for (size_t i = 0; i < targets.size(); ++i) {
        const TargetConfig& config = targets[i];
        PlacedTarget& target = all.emplace_back();
        target.strength_db = config.strength_db.value_or(0);
        if (config.geodetic) {
            const std::string diagnostic = placeOnEarth(*config.geodetic, datum, target.in_world);
            if (!diagnostic.empty()) diagnostics.push_back({fmt::format("targets[{}].geodetic", i), diagnostic});
        } else if (config.attached_to.empty())
            target.in_world = config.position.value_or(glm::dvec3(0));
        else if (const std::string diagnostic = attach(scene, config, moving, target); !diagnostic.empty())
            diagnostics.push_back({fmt::format("targets[{}].attached_to", i), diagnostic});
    }
    return all;
}

std::shared_ptr<const Scene> SceneTask::loadModels() const {
    std::shared_ptr<const Scene> models;
    if (!config->file.empty()) models = sharedScene(inputPath(config->file));
    if (config->gazebo) {
        if (scene_gazebo_ != config->gazebo) gazebo_failure_.reset();
        scene_gazebo_ = config->gazebo;
        if (gazebo_failure_) throw types::ConfigError(*gazebo_failure_);
        if (environment().is_refused) throw framework::ReportedByCheck(types::Diagnostics{});
        try {
            models = sharedWorld(*config->gazebo, inputPath(""));
        } catch (const types::ConfigError& error) {
            const types::Diagnostic& first = error.diagnostics().front();
            gazebo_failure_.emplace("", "gazebo" + (first.path.empty() ? "" : "." + first.path), first.message);
            throw types::ConfigError(*gazebo_failure_);
        }
    }
    read_ = models;
    if (models && config->placement) models = std::make_shared<const Scene>(placed(*models, *config->placement));
    if (!models) return models;
    types::Diagnostics diagnostics;
    if (!config->scale.empty()) models = std::make_shared<const Scene>(scaled(*models, config->scale, diagnostics));
    if (!diagnostics.empty()) throw types::ConfigError(diagnostics);
    return std::make_shared<const Scene>(withoutOmitted(*models, omitRules()));
}

OmitRules SceneTask::omitRules() const {
    OmitRules rules{config->omit, config->omit_drawings, config->water_surface, {}};
    for (const auto& [name, acoustics] : config->materials) rules.solid.insert(name);
    return rules;
}

std::shared_ptr<const Scene> SceneTask::load() const {
    const std::string file = inputPath(config->file).string();
    const bool has_survey = config->bathymetry.has_value();
    const std::optional<MosaicConfig> map = has_survey ? config->bathymetry->map : std::nullopt;
    if (scene_ && scene_file_ == file && scene_gazebo_ == config->gazebo && scene_has_survey_ == has_survey &&
        scene_map_ == map && scene_placement_ == config->placement && scene_scale_ == config->scale &&
        scene_rules_ == omitRules())
        return scene_;
    if (config->file.empty() && !config->gazebo && !has_survey)
        throw types::ConfigError(
            "", name() + ".file",
            "is missing; give the path of a " + sceneEndings() + " file, or gazebo, or bathymetry");
    scene_ = loadModels();
    if (has_survey) {
        Scene scene;
        scene.geometry = std::make_shared<const types::Geometry>();
        if (scene_) scene = *scene_;
        Bathymetry::addMaterials(scene, *config->bathymetry);
        scene_ = std::make_shared<const Scene>(std::move(scene));
    }
    scene_file_ = file;
    scene_gazebo_ = config->gazebo;
    scene_has_survey_ = has_survey;
    scene_map_ = map;
    scene_placement_ = config->placement;
    scene_scale_ = config->scale;
    scene_rules_ = omitRules();
    return scene_;
}

std::map<std::string, Acoustics> SceneTask::materials(types::Diagnostics& diagnostics) const {
    std::map<std::string, Acoustics> all = config->materials;
    for (auto& [name, acoustics] : all) {
        if (!acoustics.table) continue;
        types::Diagnostics found;
        acoustics.table = inputPath(*acoustics.table).string();
        acoustics.readTable("", found);
        for (const types::Diagnostic& each : found)
            diagnostics.push_back({"materials." + name + "." + each.path, each.message});
    }
    return all;
}

framework::InputPortBase* SceneTask::makeInput(const std::string& port, framework::OutputPortBase&) {
    constexpr std::string_view ending = ".pose";
    if (port.ends_with(time_ending)) return makeTimeInput(port);
    if (!port.ends_with(ending)) return nullptr;
    const std::string node = port.substr(0, port.size() - ending.size());
    try {
        if (findNode(*load(), node) < 0) return nullptr;
    } catch (const types::ConfigError&) {
        // check() reports the errors of the file; the port may be valid
    }
    const std::string doc = "place of " + node + " in the world";
    auto made = std::make_unique<framework::InputPort<types::Pose>>(this, port, doc, framework::Need::Optional);
    return movables_.emplace_back(Movable{std::move(made), node, -1, {}, {}, {}, {}}).port.get();
}

framework::InputPortBase* SceneTask::makeTimeInput(const std::string& port) {
    const std::string name = port.substr(0, port.size() - time_ending.size());
    try {
        const auto scene = load();
        if (!scene->animations || std::ranges::count(scene->animations->all, name, &Animation::name) == 0)
            return nullptr;
    } catch (const types::ConfigError&) {
        // check() reports what is wrong with the file; the port may well be right
    }
    auto made = std::make_unique<framework::InputPort<double>>(this, port, "time within the animation " + name + " [s]",
                                                               framework::Need::Optional);
    return timed_.emplace_back(Timed{std::move(made), name, {}, {}}).port.get();
}

std::unique_ptr<Bathymetry> SceneTask::openSurvey() const {
    if (!config->bathymetry) return nullptr;
    const auto& map = config->bathymetry->map;
    return std::make_unique<Bathymetry>(*config->bathymetry, inputPath(config->bathymetry->file),
                                        map ? inputPath(map->file) : std::filesystem::path(), config->datum);
}

void SceneTask::check(types::Diagnostics& diagnostics) const try {
    const bool has_two_places = config->bathymetry && config->bathymetry->easting && config->datum;
    if (has_two_places)
        diagnostics.push_back({"bathymetry.easting", "is given with northing, and the world's zero has a datum, " +
                                                         text(*config->datum) + "; give one of both"});
    else
        try {
            openSurvey();
        } catch (const types::ConfigError& error) {
            for (const types::Diagnostic& each : error.diagnostics())
                diagnostics.push_back({config->bathymetry->map && each.file == inputPath(config->bathymetry->map->file)
                                           ? "bathymetry.map.file"
                                           : "bathymetry.file",
                                       each.text()});
        }
    overrideMaterials(*load(), materials(diagnostics), diagnostics);
    scene::placeTargets(*load(), config->targets, {}, diagnostics, config->datum);
    if (!config->animations.empty()) Animator(load(), config->animations, {}, diagnostics);
} catch (const types::ConfigError& error) {
    for (const types::Diagnostic& each : error.diagnostics())
        diagnostics.push_back(config->gazebo || each.path.starts_with("scale.") || each.path.starts_with("bathymetry.")
                                  ? types::Diagnostic{each.path, each.message}
                                  : types::Diagnostic{"file", each.text()});
}

std::string SceneTask::indivisible() const {
    return config->gazebo ? "gazebo: is the world as it is when it is asked for, not the same for each shard; a file is"
                          : "";
}

types::Notices SceneTask::notices() const {
    types::Notices all = geometry_ ? geometry_->notices : types::Notices{};
    if (scene_) addOmissions(*scene_, all);
    all.insert(all.end(), placement_notices_.begin(), placement_notices_.end());
    if (const std::string place = bathymetry_ ? bathymetry_->placeText() : ""; !place.empty()) all.push_back(place);
    if (animator_) all.insert(all.end(), animator_->notices().begin(), animator_->notices().end());
    return all;
}

/** Describes the scene's orientation if a connected task has its own world frame for the poses, or if the scene is
 *  placed. */
std::string SceneTask::layText(const Scene& scene) const {
    const auto given = framework::upstreamValue(pose, {"world_frame"});
    const std::string* const name = given ? std::get_if<std::string>(&*given) : nullptr;
    if ((config->file.empty() && !config->gazebo) || (!name && !config->placement)) return "";
    auto frame = types::WorldFrame::AsIs;
    for (size_t i = 0; name && i < std::size(types::EnumNames<types::WorldFrame>::names); ++i)
        if (types::EnumNames<types::WorldFrame>::names[i] == *name) frame = static_cast<types::WorldFrame>(i);
    return describeLay(scene, config->placement.value_or(Placement{}), frame);
}

/** Returns how the scene lies, and what to ask about it: whether it is on its side, and its unit. */
types::Notices SceneTask::describePlacement(const Scene& scene) const {
    types::Notices all;
    if (const std::string lay = layText(scene); !lay.empty()) all.emplace_back(lay);
    if (const std::string side = sideWarning(*scene.geometry, config->file); !side.empty())
        all.push_back(types::warning(side));
    if (config->placement && config->placement->scale) return all;  // which answers the question
    if (const auto unit = askUnit(config->file, types::getExtent(*scene.geometry).size(),
                                  "set placement.scale: 0.001, else placement.scale: 1"))
        all.push_back(*unit);
    return all;
}

std::shared_ptr<const Scene> SceneTask::loadToRun() try {
    gazebo_failure_.reset();  // Gazebo may run by now
    return load();
} catch (const types::ConfigError& error) {
    if (!gazebo_failure_) throw;
    throw types::ConfigError("", name() + "." + error.diagnostics().front().path, error.diagnostics().front().message);
}

bool SceneTask::configureHook() {
    const auto scene = loadToRun();
    types::Diagnostics diagnostics;
    geometry_ = overrideMaterials(*scene, materials(diagnostics), diagnostics);
    if (config->materials_by_name) geometry_ = applyMaterialNames(geometry_);
    bathymetry_ = openSurvey();
    for (Movable& movable : movables_) {
        movable.node = findNode(*scene, movable.node_name);
        movable.parts = getParts(*scene, movable.node);
    }
    placeTargets(*scene, diagnostics);
    part_count_ = 0;
    for (const Movable& movable : movables_) part_count_ += movable.parts.size();
    makeAnimator(scene, diagnostics);
    if (!diagnostics.empty())
        throw types::ConfigError("", name() + "." + diagnostics.front().path, diagnostics.front().message);
    placement_notices_ = describePlacement(*scene);
    std::ranges::sort(movables_, {}, &Movable::node);
    movable_objects_ = getMovableObjects();
    mover_.assign(geometry_->objects.size(), nullptr);
    return true;
}

void SceneTask::placeTargets(const Scene& scene, types::Diagnostics& diagnostics) {
    std::vector<int> moving;
    for (const Movable& movable : movables_) moving.push_back(movable.node);
    targets_ = scene::placeTargets(scene, config->targets, moving, diagnostics, config->datum);
    std::vector<std::string> names;
    for (const TargetConfig& target : config->targets) names.push_back(target.name);
    target_names_ = std::make_shared<const std::vector<std::string>>(std::move(names));
}

void SceneTask::makeAnimator(const std::shared_ptr<const Scene>& scene, types::Diagnostics& diagnostics) {
    animator_.reset();
    driven_.clear();
    if (!scene->animations && config->animations.empty()) return;
    std::vector<int> nodes;
    for (const Movable& movable : movables_) nodes.push_back(movable.node);
    animator_ = std::make_unique<Animator>(scene, config->animations, nodes, diagnostics);
    driven_.resize(movables_.size());
    part_count_ += geometry_->objects.size();
}

bool SceneTask::startHook() {
    for (Movable& movable : movables_) {
        movable.world_from_body.reset();
        movable.newest = movable.arrived = now();
        movable.rate = glm::dmat4(0);
        if (activity().settings().trigger.empty()) movable.port->setTriggers(false);
    }
    for (Timed& timed : timed_) {
        timed.newest.reset();
        if (activity().settings().trigger.empty()) timed.port->setTriggers(false);
    }
    if (animator_) animator_->forgetTimes();
    newest_ = arrived_ = now();
    newest_came_ = waiting_is_reported_ = is_stale_ = false;
    if (bathymetry_) bathymetry_->forget();
    return true;
}

double SceneTask::poseTimeout() const {
    const bool on_wall = activity().realtime() && environment().wall_clock;
    return config->pose_timeout.value_or(on_wall ? 1 : std::numeric_limits<double>::infinity());
}

/** Returns a quarter of the timeout, the max delay until the timeout is noticed [s]. */
double SceneTask::wakeAfter() const { return std::isfinite(poseTimeout()) ? poseTimeout() / 4 : 0; }

/** A stamp far ahead of the clock, as after the clock was set back, is stale too. */
std::string SceneTask::staleness() const {
    const auto stale = [this](types::Time newest) {
        const double age = (now() - newest).seconds();
        return age > poseTimeout() || -age > std::max(1.0, poseTimeout());
    };
    const auto text = [this](const auto& port, types::Time newest, types::Time arrived) {
        const double behind = (arrived - newest).seconds();
        const bool arrives =
            types::elapsed(arrived, now()).seconds() <= poseTimeout() && 2 * std::abs(behind) > poseTimeout();
        return fmt::format("{}: no pose in the last {:g} s (pose_timeout){}", port.path(), poseTimeout(),
                           arrives
                               ? fmt::format("; the poses that arrive have stamps {:.3g} s {} this clock; if they "
                                             "are of another clock, set `stamp: arrival` in the task that reads them",
                                             std::abs(behind), behind > 0 ? "behind" : "ahead of")
                               : "");
    };
    if (stale(newest_)) return text(pose, newest_, arrived_);
    for (const Movable& movable : movables_)
        if (movable.port->connected() && stale(movable.newest))
            return text(*movable.port, movable.newest, movable.arrived);
    return {};
}

void SceneTask::lackPose(const std::string& why) {
    const bool is_first = !newest_came_ && types::elapsed(newest_, now()).seconds() > poseTimeout();
    is_stale_ = !is_first;
    if (!is_first) return error(why);
    if (!std::exchange(waiting_is_reported_, true)) warn(pose.path() + ": waits for the first pose");
}

void SceneTask::updateHook() try {
    const bool movables_good = readMovables();
    types::Pose body;
    const bool is_new = pose.readNext(body);
    if (is_new && !isUsable(body)) return is_stale_ = false, error(pose.path() + unusable);
    if (is_new) newest_ = body.time, arrived_ = now(), newest_came_ = true;
    if (is_new && odd_lengths_.isDue(types::isOddlyLong(body.orientation)))
        warn(fmt::format(
            "{}: the orientation is a quaternion of length {:.4g}, which is made 1: are its parts degrees, or "
            "in another order?",
            pose.path(), glm::length(body.orientation)));
    if (const std::string stale = staleness(); !stale.empty()) return lackPose(stale);
    is_stale_ = false;
    if (!is_new) return movables_good ? void() : error(name() + unusable);
    if (state() == framework::TaskState::RunTimeError) recover();
    const auto sample = pool_.take();
    sample->time = body.time;
    place(body, config->mount, sample->sonar);
    sample->max_extrapolation = config->extrapolate.value_or(0);
    if (config->extrapolate) moveAlong(body, config->mount, sample->sonar);
    sample->geometry = bathymetry_ ? bathymetry_->about(sample->sonar.position, geometry_) : geometry_;
    sample->ahead = bathymetry_ ? bathymetry_->ahead() : nullptr;
    sample->water_surface = config->water_surface;
    warnAboveWater(sample->sonar.position.z);
    if (animator_) animate(body.time);
    addMoved(sample->moved);
    sample->movable = movable_objects_;
    if (animator_) animator_->addMoved(sample->moved), animator_->addDeformed(*sample);
    addHidden(sample->moved);
    addTargets(sample->targets);
    sample->target_names = target_names_;
    pool_.stock(*sample, [this](types::Snapshot& stocked) { stocked.moved.reserve(part_count_); });
    snapshot.write(sample);
    if (!movables_good) error(name() + unusable);
} catch (const SurveyError& failure) {
    error(failure.what());
}

void SceneTask::warnAboveWater(double z) {
    const double height = config->water_surface ? z - *config->water_surface : 0;
    if (above_water_.isDue(height > 0))
        warn(fmt::format("{}: the sonar is {:.3g} m above the water surface (z is up: depths are negative)",
                         pose.path(), height));
}

/** Takes the newest pose of each movable. Returns false if one was unusable, which leaves that node at its place. */
bool SceneTask::readMovables() {
    bool good = true;
    types::Pose sample;
    for (Movable& movable : movables_) {
        if (movable.port->readNewest(sample, false) != framework::FlowStatus::NewData) continue;
        if (isUsable(sample)) {
            sample.orientation = glm::normalize(sample.orientation);
            const glm::dmat4 place = sample.worldFromBody();
            if (animator_) movable.rate = computeRate(sample, place, movable.world_from_body, movable.newest);
            movable.newest = sample.time, movable.arrived = now();
            movable.world_from_body = place;
        } else {
            good = false;
        }
    }
    return good;
}

void SceneTask::readTimes(types::Time time) {
    for (Timed& timed : timed_) {
        double sample = 0;
        if (timed.port->readNewest(sample, false) != framework::FlowStatus::NewData) continue;
        if (!std::isfinite(sample)) {
            warn(timed.port->path() + ": is not a finite number, dropped");
            continue;
        }
        const double since = (time - timed.taken).seconds();
        const double rate = timed.newest && since > 0 ? (sample - *timed.newest) / since : 0;
        timed.newest = sample;
        timed.taken = time;
        animator_->setTime(timed.animation, sample, rate);
    }
}

/** Takes the shape of the scene at a time, and where ports have put nodes. */
void SceneTask::animate(types::Time time) {
    readTimes(time);
    const auto scene = scene_;
    for (size_t i = 0; i < movables_.size(); ++i) {
        const Movable& movable = movables_[i];
        driven_[i].node = movable.node;
        driven_[i].world_from_node.reset();
        if (!movable.world_from_body) continue;
        const glm::dmat4 body_from_node = bodyFromNode(*scene, movable.node);
        driven_[i].world_from_node = *movable.world_from_body * body_from_node;
        driven_[i].rate = movable.rate * body_from_node;
    }
    animator_->take((environment().elapsed() + (time - now())).seconds(), driven_);
}

void SceneTask::setHideable(std::vector<uint32_t> objects) {
    hideable_ = std::move(objects);
    movable_objects_ = getMovableObjects();
}

void SceneTask::addHidden(std::vector<types::MovedObject>& moved) const {
    constexpr double depth = 1e5;  // [m]
    for (const uint32_t object : hidden_) {
        glm::dmat4 place = geometry_->objects[object].world_from_object;
        place[3].z -= depth;
        const auto found = std::ranges::find(moved, object, &types::MovedObject::object);
        if (found == moved.end())
            moved.push_back({object, place});
        else
            *found = {object, place};
    }
}

std::shared_ptr<const std::vector<uint32_t>> SceneTask::getMovableObjects() const {
    std::set<uint32_t> objects(hideable_.begin(), hideable_.end());
    for (const Movable& movable : movables_)
        for (const Part& part : movable.parts) objects.insert(static_cast<uint32_t>(part.object));
    if (objects.empty()) return nullptr;
    return std::make_shared<const std::vector<uint32_t>>(objects.begin(), objects.end());
}

/** Adds the moved objects. Each object follows the innermost of its nodes that has a pose. */
void SceneTask::addMoved(std::vector<types::MovedObject>& moved) {
    for (const Movable& movable : movables_)
        if (movable.world_from_body)
            for (const Part& part : movable.parts) mover_[part.object] = &movable;
    moved.clear();
    moved.reserve(part_count_);
    for (const Movable& movable : movables_)
        if (movable.world_from_body)
            for (const Part& part : movable.parts)
                if (mover_[part.object] == &movable)
                    moved.push_back({part.object, *movable.world_from_body * part.body_from_object});
}

const SceneTask::Movable* SceneTask::findMovable(int node) const {
    const auto found = std::ranges::find(movables_, node, &Movable::node);
    return found == movables_.end() ? nullptr : &*found;
}

/** Adds the point targets. Each target follows the innermost node at or above its own that has a pose or is
 *  animated. */
void SceneTask::addTargets(std::vector<types::PointTarget>& targets) const {
    targets.clear();
    for (const PlacedTarget& placed : targets_) {
        types::PointTarget& target = targets.emplace_back(placed.in_world, placed.strength_db);
        if (animator_ && placed.node >= 0 && animator_->isAnimated(placed.node)) {
            target.position = animator_->getPlace(placed.node, placed.offset);
            continue;
        }
        for (const PlacedTarget::Carrier& carrier : placed.carriers)
            if (const auto& body = findMovable(carrier.node)->world_from_body) {
                target.position = glm::dvec3(*body * glm::dvec4(carrier.place, 1));
                break;
            }
    }
}

void SceneTask::cleanupHook() {
    geometry_.reset();
    bathymetry_.reset();
    scene_.reset();
    read_.reset();
    animator_.reset();
    pool_ = {};
}

void registerTasks(framework::Registry& registry) {
    registry.add<SceneTask>("scene::SceneTask",
                            "holds a scene and publishes what is in front of the sonar at each pose");
}

}  // namespace insonify::scene
