#include "components/deployer/Simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/deployer/log/ReplaySpec.hpp"
#include "components/framework/Offers.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Wiring.hpp"
#include "components/framework/execution/Activity.hpp"
#include "components/scene/SceneTask.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::deployer {
namespace {

using framework::DeploymentSpec;
using framework::splitPort;

constexpr const char* scene_type = "scene::SceneTask";
constexpr const char* feed_type = "deployer::PoseFeed";
constexpr const char* object_feed = "placed_objects";
constexpr const char* busy = "another thread uses this simulation";
constexpr double longest_step = 86400;  ///< [s]

bool isScenePose(const DeploymentSpec& spec, const framework::ConnectionSpec& connection) {
    const auto [task, port] = splitPort(connection.to);
    const framework::TaskSpec* const scene = spec.task(task);
    return scene && scene->type == scene_type && port == "pose";
}

bool carriesPings(const framework::PortBase& port) { return port.typeName() == types::Sonar::type_name; }

/** Returns the outputs of pings that no other task of the deployment reads. */
std::vector<framework::OutputPortBase*> lastPings(const framework::Deployment& deployment) {
    std::vector<framework::OutputPortBase*> last;
    for (const auto& task : deployment.tasks()) {
        if (std::ranges::any_of(deployment.connections(), [&](const framework::Connection& connection) {
                return &connection.from->owner() == task.get() && carriesPings(*connection.from);
            }))
            continue;
        for (framework::OutputPortBase* port : task->outputs())
            if (carriesPings(*port)) last.push_back(port);
    }
    return last;
}

/** Returns the truth port of the sonar whose pings a task gets; null: no such sonar writes truth. */
framework::OutputPortBase* truthBehind(const framework::Deployment& deployment, framework::TaskContext* task) {
    for (size_t steps = 0; task && steps < deployment.tasks().size(); ++steps) {
        if (framework::OutputPortBase* truth = task->output("truth")) return truth;
        framework::TaskContext* before = nullptr;
        for (const framework::Connection& connection : deployment.connections())
            if (&connection.to->owner() == task && carriesPings(*connection.to)) before = &connection.from->owner();
        task = before;
    }
    return nullptr;
}

std::set<std::string> tasksThatLeadToPings(const framework::Deployment& deployment) {
    std::set<std::string> names;
    for (const auto& task : deployment.tasks())
        for (const framework::OutputPortBase* port : task->outputs())
            if (carriesPings(*port)) names.insert(task->name());
    return upstream(std::move(names), deployment);
}

void throwAny(const std::vector<std::string>& failures) {
    if (!failures.empty()) throw std::runtime_error(failures.front());
}

/** Returns the deployment without those tasks and their connections. */
DeploymentSpec without(DeploymentSpec spec, const std::set<std::string>& omitted) {
    std::set<std::string> kept;
    for (const std::string& name : spec.taskNames())
        if (!omitted.contains(name)) kept.insert(name);
    return restrictedTo(std::move(spec), kept);
}

}  // namespace

Simulation::Simulation(const std::string& file, SimulationOptions options) : registry_(coreTasks()) {
    registry_.add<PoseFeed>(feed_type, "poses that the caller gives");
    DeploymentSpec spec = DeploymentSpec::load(deploymentIn(file));
    for (const std::string& assignment : options.overrides) {
        spec.set(assignment);
        if (const auto end = assignment.find(".seed="); end != std::string::npos)
            own_seeds_.insert(assignment.substr(0, end));
    }
    spec.lockstep = true;
    start_time_ = spec.start_time;
    replacePoses(spec);
    addObjects(spec, options.objects);
    spec = without(spec, outsideTasks(spec));
    spec = restrictedTo(spec, tasksThatLeadToPings(framework::Deployment(spec, registry_)));
    if (options.period && !(*options.period > 0))
        throw types::ConfigError("", "period", fmt::format("is {:g}; must be above 0 s", *options.period));
    if (options.period) period_ = *options.period;
    deployment_ = std::make_unique<framework::Deployment>(spec, registry_, ".", options.seed);
    for (const std::string& port : poses_)
        feeds_.push_back(&dynamic_cast<PoseFeed&>(*deployment_->task(splitPort(port).first)));
    connectReaders(options.truth);
    for (const auto& task : deployment_->tasks())
        if (auto* const sonar = dynamic_cast<sonar::PingTask*>(task.get())) sonar->useThreads(options.threads);
    deployment_->onWarning([this](const std::string& text) {
        std::string kind = text;
        std::erase_if(kind, [](char c) { return c >= '0' && c <= '9'; });
        if (warned_.insert(kind).second) warnings_.push_back(text);
    });
    deployment_->configure();
    start();
}

types::Notices Simulation::notices() const {
    const std::unique_lock use(in_use_, std::try_to_lock);
    if (!use) throw std::runtime_error(busy);
    types::Notices all;
    const auto add = [&](const framework::TaskContext& task, const types::Notices& notices) {
        for (const types::Notice& notice : notices)
            if (const types::Notice named(task.name() + ": " + notice.text, notice.kind);
                std::ranges::count(all, named) == 0)
                all.push_back(named);
    };
    for (const auto& task : deployment_->tasks()) {
        add(*task, task->notices());
        if (const types::Plan* plan = framework::makePlan(*task)) add(*task, plan->notices);
    }
    return all;
}

void Simulation::replacePoses(DeploymentSpec& spec) {
    std::set<std::string> replaced;
    for (const framework::ConnectionSpec& connection : spec.connections)
        if (isScenePose(spec, connection)) replaced.insert(splitPort(connection.from).first);
    for (const framework::ConnectionSpec& connection : spec.connections)
        if (replaced.contains(splitPort(connection.from).first) && std::ranges::count(poses_, connection.from) == 0)
            poses_.push_back(connection.from);
    if (poses_.empty())
        throw types::ConfigError(spec.file, "connections",
                                 "none leads to the pose of a scene; there is nothing to step");
    std::vector<framework::TaskSpec> tasks;  // a new list: assigning a YAML node would change its other references
    for (const framework::TaskSpec& task : spec.tasks) {
        if (!replaced.contains(task.name)) {
            tasks.push_back(task);
            continue;
        }
        if (task.activity.periodic()) period_ = task.activity.period;
        framework::TaskSpec& feed = tasks.emplace_back();
        feed.name = task.name;
        feed.type = feed_type;
    }
    spec.tasks.swap(tasks);
}

std::string Simulation::objectPort(const std::string& node) { return std::string(object_feed) + "." + node; }

void Simulation::addObjects(DeploymentSpec& spec, const std::vector<std::string>& nodes) {
    if (nodes.empty()) return;
    std::vector<std::string> scenes;
    for (const framework::TaskSpec& task : spec.tasks)
        if (task.type == scene_type) scenes.push_back(task.name);
    for (const std::string& node : nodes) {
        poses_.push_back(objectPort(node));
        for (const std::string& scene : scenes) {
            const std::string input = scene + "." + node + ".pose";
            for (const framework::ConnectionSpec& other : spec.connections)
                if (other.to == input)
                    throw types::ConfigError(spec.file, other.path, "moves " + node + ", which the caller places");
            framework::ConnectionSpec& connection = spec.connections.emplace_back();
            connection.from = objectPort(node);
            connection.to = input;
            connection.path = "objects";
        }
    }
    framework::TaskSpec& feed = spec.tasks.emplace_back();
    feed.name = object_feed;
    feed.type = feed_type;
}

void Simulation::connectReaders(bool truth) {
    const auto last = lastPings(*deployment_);
    if (last.empty()) throw types::ConfigError(deployment_->spec().file, "tasks", "none makes pings");
    for (framework::OutputPortBase* port : last) {
        PingReader& reader = *readers_.emplace_back(std::make_unique<PingReader>(port->path()));
        port->connectTo(reader.ping, framework::ConnPolicy::buffer(4));
        if (!truth) continue;
        framework::OutputPortBase* const reported = truthBehind(*deployment_, &port->owner());
        if (!reported)
            throw types::ConfigError(deployment_->spec().file, port->path(),
                                     "is not from a sonar that writes its truth");
        reported->connectTo(reader.truth, framework::ConnPolicy::buffer(4));
        if (framework::OutputPortBase* const image = reported->owner().output("range_image")) {
            image->connectTo(reader.range_image, framework::ConnPolicy::buffer(4));
            reported->owner().output("range_truth")->connectTo(reader.range_truth, framework::ConnPolicy::buffer(4));
        }
    }
}

void Simulation::start() {
    throwAny(deployment_->start());
    time_ = start_time_;
    last_.reset();
}

std::vector<std::string> Simulation::pings() const {
    std::vector<std::string> ports;
    for (const auto& reader : readers_) ports.push_back(reader->name());
    return ports;
}

types::Time Simulation::timeOfStep(double seconds) const {
    if (!std::isfinite(seconds)) throw std::invalid_argument("the time of a step is not finite");
    constexpr double latest = 9e12;  // microseconds of 64 bits
    if (std::abs(seconds) > latest)
        throw std::invalid_argument(
            fmt::format("the time of a step is {:g} s; may be {:g} to {:g} s", seconds, -latest, latest));
    const types::Time now = types::Time::fromSeconds(seconds);
    if (last_ && !(*last_ < now))
        throw std::runtime_error(fmt::format("the step is at {:g} s; it must be after the one before, at {:g} s",
                                             seconds, last_->seconds()));
    const double ahead = seconds - (last_ ? last_->seconds() : start_time_);
    const bool others_go_on = std::ranges::any_of(
        deployment_->tasks(), [](const auto& task) { return task->activity().settings().periodic(); });
    if (others_go_on && ahead > longest_step)
        throw std::runtime_error(
            fmt::format("the step is {:g} s after the one before or the start, in which tasks with a period continue; "
                        "at most {:g} s",
                        ahead, longest_step));
    return now;
}

std::vector<SteppedPing> Simulation::step(std::map<std::string, types::Pose> at, std::optional<double> time) {
    const std::unique_lock use(in_use_, std::try_to_lock);
    if (!use) throw std::runtime_error(busy);
    const types::Time now = timeOfStep(time.value_or(time_));
    for (const std::string& port : poses_)
        if (!at.contains(port)) throw std::runtime_error("no pose is given for " + port);
    last_ = now;
    for (size_t i = 0; i < poses_.size(); ++i) {
        types::Pose& given = at.at(poses_[i]);
        given.time = now;
        feeds_[i]->give(splitPort(poses_[i]).second, given);
    }
    while (std::ranges::any_of(feeds_, [](const PoseFeed* feed) { return feed->nextTime().has_value(); }))
        if (!deployment_->advance()) break;
    time_ = now.seconds() + period_;
    throwErrors();
    std::vector<SteppedPing> made(readers_.size());
    for (size_t i = 0; i < readers_.size(); ++i) {
        readers_[i]->ping.readNewest(made[i].ping, false);
        readers_[i]->truth.readNewest(made[i].truth, false);
        readers_[i]->range_image.readNewest(made[i].range_image, false);
        readers_[i]->range_truth.readNewest(made[i].range_truth, false);
    }
    return made;
}

void Simulation::set(const std::map<std::string, std::string>& values) {
    const std::unique_lock use(in_use_, std::try_to_lock);
    if (!use) throw std::runtime_error(busy);
    deployment_->set(values, framework::set_origin);
    for (const auto& [property, value] : values)
        if (property.ends_with(".seed")) own_seeds_.insert(property.substr(0, property.size() - 5));
}

void Simulation::setHideable(const std::vector<uint32_t>& objects) {
    for (const auto& task : deployment_->tasks())
        if (auto* const scene = dynamic_cast<scene::SceneTask*>(task.get())) scene->setHideable(objects);
}

void Simulation::hide(const std::vector<uint32_t>& objects) {
    for (const auto& task : deployment_->tasks())
        if (auto* const scene = dynamic_cast<scene::SceneTask*>(task.get())) scene->hide(objects);
}

void Simulation::throwErrors() const {
    for (const auto& task : deployment_->tasks())
        if (framework::hasFailed(*task) || task->state() == framework::TaskState::RunTimeError)
            throw std::runtime_error(task->name() + ": " + task->lastError());
}

void Simulation::refuseSeed(std::optional<uint64_t> seed) {
    if (seed == 0) throw std::invalid_argument("a seed of 0 means the deployment's own; make a new simulation for it");
}

void Simulation::reset(std::optional<uint64_t> seed) {
    refuseSeed(seed);
    const std::unique_lock use(in_use_, std::try_to_lock);
    if (!use) throw std::runtime_error(busy);
    throwAny(deployment_->stop());
    for (const auto& reader : readers_)
        reader->ping.clear(), reader->truth.clear(), reader->range_image.clear(), reader->range_truth.clear();
    for (const auto& task : deployment_->tasks()) {
        if (deployment_->spec().task(task->name())->type == scene_type) continue;
        auto* const sonar = dynamic_cast<sonar::PingTask*>(task.get());
        const framework::Outcome cleaned = sonar ? sonar->restart() : task->cleanup();
        if (!cleaned) throw std::runtime_error(cleaned.reason);
        for (framework::PropertiesBase* properties : task->properties())
            for (const framework::PropertyInfo& property : properties->list())
                if (seed && property.name == "seed" && !own_seeds_.contains(task->name()))
                    properties->set("seed", std::to_string(framework::computeSeed(*seed, task->name())));
        if (sonar) continue;
        if (const framework::Outcome outcome = task->configure(); !outcome) throw std::runtime_error(outcome.reason);
    }
    start();
}

}  // namespace insonify::deployer
