#include "components/framework/Wiring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "components/framework/Offers.hpp"
#include "components/framework/Properties.hpp"
#include "types/Hash.hpp"

namespace insonify::framework {
namespace {

std::vector<std::string> typesOf(const Registry& registry) {
    std::vector<std::string> types;
    for (const Registry::Entry& entry : registry.list()) types.push_back(entry.type);
    return types;
}

}  // namespace

uint64_t seedOf(uint64_t seed, const std::string& task) {
    uint64_t hash = 0xcbf29ce484222325;  // FNV-1a of the name, then splitmix64 with the seed
    for (const char c : task) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    return types::mixedBits(hash + seed * 0x9e3779b97f4a7c15) >> 11;
}

Graph Wiring::make(uint64_t seed) {
    diagnostics_ = spec_.diagnostics;
    loadLibraries();
    makeTasks();
    loadProperties(seed);
    connect();
    checkTasks();
    checkLoops();
    const auto earlier = [](const auto& a, const auto& b) {
        return std::tie(a.file, a.line, a.column) < std::tie(b.file, b.line, b.column);
    };
    std::stable_sort(diagnostics_.begin(), diagnostics_.end(), earlier);
    std::stable_sort(consequences_.begin(), consequences_.end(), earlier);
    diagnostics_.insert(diagnostics_.end(), consequences_.begin(), consequences_.end());
    if (!diagnostics_.empty()) throw types::ConfigError(diagnostics_);
    return std::move(graph_);
}

types::Diagnostic Wiring::diagnostic(const YAML::Node& place, const std::string& path,
                                     const std::string& message) const {
    ConfigReader reader(spec_.file);
    reader.report(place, path, message);
    return reader.diagnostics().front();
}

void Wiring::report(const YAML::Node& place, const std::string& path, const std::string& message) {
    diagnostics_.push_back(diagnostic(place, path, message));
}

void Wiring::consequence(const YAML::Node& place, const std::string& path, const std::string& message) {
    consequences_.push_back(diagnostic(place, path, message));
}

void Wiring::loadLibraries() {
    for (const std::string& library : spec_.libraries) try {
            registry_.loadLibrary(environment_->input_folder / library);
        } catch (const types::ConfigError& error) {
            diagnostics_.insert(diagnostics_.end(), error.diagnostics().begin(), error.diagnostics().end());
        }
}

void Wiring::makeTasks() {
    for (const TaskSpec& spec : spec_.tasks) {
        if (spec.type.empty()) continue;  // told by the reading
        auto task = registry_.make(spec.type, spec.name);
        if (!task) {
            const YAML::Node type = child(spec.place, "type");
            report(type, spec.path() + ".type", "is " + spec.type + "; " + suggestion(spec.type, typesOf(registry_)));
            continue;
        }
        task->setEnvironment(environment_);
        graph_.add(std::move(task));
    }
}

void Wiring::loadProperties(uint64_t seed) {
    for (const auto& task : graph_.tasks()) {
        TaskSpec& spec = *spec_.task(task->name());
        if (seed != 0) seedTask(*task, spec, seed);
        ConfigReader reader(spec_.file, spec_.origins);
        reader.setFallback(spec.place.Mark());
        const std::string path = spec.path() + ".properties";
        for (PropertiesBase* properties : task->properties()) properties->load(reader, spec.properties, path);
        if (task->properties().empty()) reader.refuseUnknown(spec.properties, path, {});
        if (reader.diagnostics().empty()) continue;
        unreliable_.push_back(task.get());
        diagnostics_.insert(diagnostics_.end(), reader.diagnostics().begin(), reader.diagnostics().end());
    }
}

void Wiring::seedTask(const TaskContext& task, const TaskSpec& spec, uint64_t seed) {
    const std::string path = spec.path() + ".properties.seed";
    const auto& origins = spec_.origins;
    if (const auto found = origins.find(path); found != origins.end() && found->second.file == set_origin) return;
    for (const PropertiesBase* properties : task.properties())
        for (const PropertyInfo& info : properties->list())
            if (info.name == "seed")
                return spec_.set(fmt::format("{}.seed={}", task.name(), seedOf(seed, task.name())));
}

void Wiring::connect() {
    std::vector<std::string> made;
    for (const ConnectionSpec& connection : spec_.connections) {
        const std::string text = connection.from + ">" + connection.to;
        if (std::find(made.begin(), made.end(), text) != made.end())
            report(connection.place, connection.path, "stands here twice: " + text);
        else
            connectOne(connection);
        made.push_back(text);
    }
}

void Wiring::connectOne(const ConnectionSpec& connection) {
    OutputPortBase* from = findOutput(connection);
    if (!from) {
        findTask(connection, "to", connection.to);  // tells when that one is unknown as well
        return;
    }
    InputPortBase* to = findInput(connection, *from);
    if (!to) return;
    if (&from->owner() == &to->owner())
        return report(connection.place, connection.path, "connects " + from->owner().name() + " with itself");
    if (!from->content().empty() && !to->content().empty() && from->content() != to->content())
        return report(connection.place, connection.path,
                      fmt::format("{} gives {}, {} takes {}; the one cannot be the other", from->path(),
                                  from->content(), to->path(), to->content()));
    if (!graph_.connect(*from, *to, connection.policy))
        return report(connection.place, connection.path,
                      fmt::format("{} is {}, {} is {}; types must be equal", from->path(), from->typeName(), to->path(),
                                  to->typeName()));
}

TaskContext* Wiring::findTask(const ConnectionSpec& connection, const char* key, const std::string& port) {
    const std::string name = splitPort(port).first;
    TaskContext* task = graph_.task(name);
    if (!task && !spec_.task(name))
        report(child(connection.place, key), connection.path + "." + key,
               "there is no task " + name + "; " + suggestion(name, spec_.taskNames()));
    return task;
}

bool Wiring::isUnreliable(const TaskContext& task) const {
    return std::find(unreliable_.begin(), unreliable_.end(), &task) != unreliable_.end();
}

OutputPortBase* Wiring::findOutput(const ConnectionSpec& connection) {
    TaskContext* task = findTask(connection, "from", connection.from);
    if (!task) return nullptr;
    const std::string name = splitPort(connection.from).second;
    if (OutputPortBase* port = task->output(name)) return port;
    const YAML::Node place = child(connection.place, "from");
    try {
        if (OutputPortBase* port = task->makeOutput(name)) return port;
        report(place, connection.path + ".from",
               fmt::format("{} has no output port {}; {}", task->name(), name,
                           suggestion(name, namesOf(task->outputs()))));
    } catch (const std::exception& error) {
        if (!isUnreliable(*task)) report(place, connection.path + ".from", error.what());
    }
    return nullptr;
}

InputPortBase* Wiring::findInput(const ConnectionSpec& connection, OutputPortBase& source) {
    TaskContext* task = findTask(connection, "to", connection.to);
    if (!task) return nullptr;
    const std::string name = splitPort(connection.to).second;
    if (InputPortBase* port = task->input(name)) return port;
    const YAML::Node place = child(connection.place, "to");
    try {
        if (InputPortBase* port = task->makeInput(name, source)) return port;
        report(
            place, connection.path + ".to",
            fmt::format("{} has no input port {}; {}", task->name(), name, suggestion(name, namesOf(task->inputs()))));
    } catch (const std::exception& error) {
        if (!isUnreliable(*task)) report(place, connection.path + ".to", error.what());
    }
    return nullptr;
}

void Wiring::checkTasks() {
    for (const auto& task : graph_.tasks()) {
        const TaskSpec& spec = *spec_.task(task->name());
        checkInputs(*task, spec);
        checkActivity(*task, spec);
        if (isUnreliable(*task)) continue;
        ConfigReader reader(spec_.file, spec_.origins);
        reader.setFallback(spec.place.Mark());
        types::Diagnostics diagnostics;
        task->check(diagnostics);
        reader.report(spec.properties, spec.path() + ".properties", diagnostics);
        diagnostics_.insert(diagnostics_.end(), reader.diagnostics().begin(), reader.diagnostics().end());
    }
}

void Wiring::checkInputs(const TaskContext& task, const TaskSpec& spec) {
    // A connection that failed has been told; that its port is now without one need not be.
    const auto meant = [&](const InputPortBase& port) {
        const auto& all = spec_.connections;
        return std::any_of(all.begin(), all.end(), [&](const auto& c) { return c.to == port.path(); });
    };
    for (const InputPortBase* port : task.inputs())
        if (port->need() == Need::Required && !port->connected() && !meant(*port))
            consequence(spec.place, spec.path(),
                        fmt::format("input port {} ({}) is not connected; it must be", port->name(), port->typeName()));
}

void Wiring::checkActivity(TaskContext& task, const TaskSpec& spec) {
    const YAML::Node place = child(spec.place, "activity");
    for (const std::string& name : spec.activity.trigger)
        if (!task.input(name))
            report(place, spec.path() + ".activity.trigger",
                   "there is no input port " + name + "; " + suggestion(name, namesOf(task.inputs())));
    const bool is_misread = std::ranges::any_of(spec_.diagnostics, [&](const types::Diagnostic& diagnostic) {
        return diagnostic.path.starts_with(spec.path() + ".activity");
    });
    if (!is_misread && !child(place, "period").IsDefined() && !hasCycles(task, spec))
        consequence(spec.place, spec.path(), "has nothing that would run it; give it activity: {period: seconds}");
    task.activity().configure(spec.activity);
}

bool Wiring::hasCycles(const TaskContext& task, const TaskSpec& spec) const {
    const auto runs = [](const InputPortBase* port) { return port->connected() || port->need() == Need::Required; };
    const auto meant = [&](const ConnectionSpec& c) { return splitPort(c.to).first == task.name(); };
    const auto* const source = dynamic_cast<const ClockSource*>(&task);
    return spec.activity.periodic() || !task.events().empty() || task.wakeAfter() > 0 ||
           (source && source->nextTime()) || std::ranges::any_of(task.inputs(), runs) ||
           std::ranges::any_of(spec_.connections, meant);
}

void Wiring::checkLoops() {
    for (const Connection* loop : graph_.unbufferedLoops()) {
        const auto made = [&](const ConnectionSpec& c) {
            return c.from == loop->from->path() && c.to == loop->to->path();
        };
        const auto& specs = spec_.connections;
        const auto spec = std::find_if(specs.begin(), specs.end(), made);
        report(spec->place, spec->path,
               loop->text() + " closes a loop without a buffer; give one of its connections one");
    }
    graph_.arrange();
}

}  // namespace insonify::framework
