#include "components/framework/Wiring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "components/framework/Offers.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "types/text/Hash.hpp"

namespace insonify::framework {
namespace {

std::vector<std::string> getTypes(const Registry& registry) {
    std::vector<std::string> types;
    for (const Registry::Entry& entry : registry.list()) types.push_back(entry.type);
    return types;
}

bool knows(PropertiesBase& properties, const std::string& key) {
    YAML::Node block(YAML::NodeType::Map);
    block.force_insert(key, YAML::Node());
    ConfigReader reader("");
    reader.removeByNull();
    properties.load(reader, block, "");
    return std::ranges::none_of(reader.diagnostics(), [&](const types::Diagnostic& diagnostic) {
        return diagnostic.path == key && diagnostic.kind == types::Diagnostic::Kind::UnknownKey;
    });
}

std::vector<std::string> topLevel(const PropertiesBase& properties) {
    std::vector<std::string> names;
    for (const PropertyInfo& info : properties.list())
        if (info.name.find_first_of(".[") == std::string::npos) names.push_back(info.name);
    return names;
}

/** Returns each name once, in the order of first appearance. */
std::vector<std::string> unique(const std::vector<std::string>& names) {
    std::vector<std::string> all;
    for (const std::string& name : names)
        if (std::ranges::count(all, name) == 0) all.push_back(name);
    return all;
}

/** Names within a block: "depth" of "water.depth". */
std::vector<std::string> within(const std::vector<std::string>& names, const std::string& block) {
    std::vector<std::string> inner;
    for (const std::string& name : names)
        if (name.starts_with(block + ".")) inner.push_back(splitPort(name.substr(block.size() + 1)).first);
    return unique(inner);
}

}  // namespace

uint64_t computeSeed(uint64_t seed, const std::string& task) {
    uint64_t hash = 0xcbf29ce484222325;  // FNV-1a of the name, then splitmix64 with the seed
    for (const char c : task) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    return types::mixedBits(hash + seed * 0x9e3779b97f4a7c15) >> 11;
}

Graph Wiring::make(uint64_t seed) {
    diagnostics_ = spec_.diagnostics;
    loadLibraries();
    makeTasks();
    loadProperties(seed);
    environment_->is_refused = !diagnostics_.empty();
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
    const types::Diagnostics wrong = registry_.loadLibraries(spec_, environment_->input_folder);
    diagnostics_.insert(diagnostics_.end(), wrong.begin(), wrong.end());
    lacks_libraries_ = !wrong.empty();
}

/** Null, with a diagnostic, when there is no such type. */
std::unique_ptr<TaskContext> Wiring::makeTask(const TaskSpec& spec) {
    const auto refuse = [&](const std::string& why) {
        report(child(spec.place, "type"), spec.path() + ".type", "is " + spec.type + why);
    };
    try {
        if (auto task = registry_.make(spec.type, spec.name)) return task;
        registry_.loadAll();  // for suggestions
        const std::string owner = spec.type.substr(0, spec.type.find(':'));
        const std::string known = suggestion(spec.type, getTypes(registry_));
        if (const Registry::Entry* const other = registry_.find(spec.type))
            refuse(fmt::format(", which is in {}; the file must be called {}.so, or be one of `libraries`",
                               other->library, owner));
        else if (lacks_libraries_ && !known.starts_with("did you mean"))
            consequence(child(spec.place, "type"), spec.path() + ".type", "is " + spec.type + ", which is not known");
        else
            refuse("; " + known +
                   (known.starts_with("did you mean")
                        ? ""
                        : "; a task of your own is in a file that `libraries` names, or in " + owner +
                              ".so in a folder of INSONIFY_COMPONENT_PATH"));
    } catch (const types::ConfigError& error) {
        for (const types::Diagnostic& each : error.diagnostics())
            refuse(each.file.empty() && (each.path.empty() || each.path == spec.type) ? ", which " + each.message
                                                                                      : ": " + each.text());
    }
    return nullptr;
}

void Wiring::makeTasks() {
    for (const TaskSpec& spec : spec_.tasks) {
        if (spec.type.empty()) continue;  // reported when the file was read
        auto task = makeTask(spec);
        if (!task) continue;
        task->setEnvironment(environment_);
        graph_.add(std::move(task));
    }
}

/** Returns "; receiver::ReceiverTask has it" for a key that one or two other types have, because it was probably
 * written into the wrong task; otherwise "". */
std::string Wiring::otherOwners(const std::string& key) const {
    constexpr size_t few = 2;
    std::vector<std::string> owners;
    registry_.loadAll();
    for (const Registry::Entry& entry : registry_.list()) {
        const auto task = Registry::example(entry);
        if (!task) continue;
        const auto has = [&](const PropertiesBase* each) { return std::ranges::count(topLevel(*each), key) > 0; };
        if (std::ranges::any_of(task->properties(), has)) owners.push_back(entry.type);
    }
    if (owners.empty() || owners.size() > few) return "";
    return owners.size() == 1 ? fmt::format("; {} has it", owners[0])
                              : fmt::format("; {} have it", fmt::join(owners, " and "));
}

void Wiring::loadProperties(uint64_t seed) {
    for (const auto& task : graph_.tasks()) {
        TaskSpec& spec = *spec_.task(task->name());
        ConfigReader reader(spec_.file, spec_.origins);
        reader.setFallback(spec.place.Mark());
        const std::string path = spec.path() + ".properties";
        const YAML::Node known = withoutUnknown(*task, spec, reader);
        try {
            for (PropertiesBase* properties : task->properties()) properties->load(reader, known, path);
        } catch (const std::exception& failure) {
            reader.report(spec.place, path, "cannot be checked: " + types::getReason(failure));
        } catch (...) {
            reader.report(spec.place, path, "cannot be checked: an exception without a reason");
        }
        if (task->properties().empty()) reader.refuseUnknown(spec.properties, path, {});
        if (reader.diagnostics().empty()) {
            seedTask(*task, spec, seed);
            placeTask(*task, spec);
            continue;
        }
        unreliable_.push_back(task.get());
        for (types::Diagnostic each : reader.diagnostics()) {
            if (each.kind == types::Diagnostic::Kind::UnknownKey && each.path.starts_with(path + "."))
                each.message += otherOwners(each.path.substr(path.size() + 1));
            diagnostics_.push_back(std::move(each));
        }
    }
}

std::vector<std::string> Wiring::aliasesOfPorts(const TaskSpec& spec, bool outputs) const {
    std::vector<std::string> names;
    for (const auto& [name, target] : spec.aliases) {
        const auto [owner, port] = splitPort(target);
        TaskContext* const task = graph_.task(owner);
        if (task && (outputs ? task->output(port) != nullptr : task->input(port) != nullptr)) names.push_back(name);
    }
    return names;
}

std::vector<std::string> Wiring::aliasesOfProperties(const TaskSpec& spec) const {
    std::vector<std::string> ports = aliasesOfPorts(spec, true), names;
    std::ranges::copy(aliasesOfPorts(spec, false), std::back_inserter(ports));
    for (const auto& [name, target] : spec.aliases)
        if (std::ranges::count(ports, name) == 0) names.push_back(name);
    for (const auto& [name, target] : spec.switches) names.push_back(name);
    return names;
}

/** Returns the part of a task's properties that the task knows. If it has aliases, unknown keys are reported here,
 *  because the task does not know its aliases. */
YAML::Node Wiring::withoutUnknown(const TaskContext& task, const TaskSpec& spec, ConfigReader& reader) const {
    const std::vector<std::string> aliases = aliasesOfProperties(spec);
    if (aliases.empty() || task.properties().size() != 1 || !spec.properties.IsDefined() || !spec.properties.IsMap())
        return spec.properties;
    PropertiesBase& properties = *task.properties().front();
    std::vector<std::string> names = topLevel(properties);
    for (const std::string& alias : aliases) names.push_back(splitPort(alias).first);
    YAML::Node known(YAML::NodeType::Map);
    for (const auto& entry : spec.properties) {
        const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
        if (key.empty() || knows(properties, key)) {
            known.force_insert(entry.first, entry.second);
            continue;
        }
        const std::string path = below(spec.path() + ".properties", key);
        if (const auto inner = within(aliases, key); entry.second.IsMap() && !inner.empty())
            reader.refuseUnknown(entry.second, path, inner);
        else
            reader.report(entry.first, path, "is not a key here; " + suggestion(key, unique(names)),
                          types::Diagnostic::Kind::UnknownKey);
    }
    return known.size() == spec.properties.size() ? spec.properties : known;
}

void Wiring::seedTask(const TaskContext& task, const TaskSpec& spec, uint64_t seed) {
    const std::string path = spec.path() + ".properties.seed";
    const auto origin = spec_.origins.find(path);
    const bool is_set = origin != spec_.origins.end() && origin->second.isOption();
    const YAML::Node written = child(spec.properties, "seed");
    if (written.IsDefined() && !written.IsNull() && (seed == 0 || is_set)) return;
    const uint64_t own = computeSeed(seed != 0 ? seed : spec_.seed, task.name());
    for (PropertiesBase* properties : task.properties())
        for (const PropertyInfo& info : properties->list())
            if (info.name == "seed") try {
                    properties->set("seed", std::to_string(own));
                } catch (const types::ConfigError& error) {  // the property has a narrower type and keeps its default
                    if (seed != 0) report(spec.place, path, error.diagnostics().front().message);
                }
}

void Wiring::placeTask(const TaskContext& task, const TaskSpec& spec) {
    const auto has = [](const PropertyInfo& info) { return info.name == "datum.latitude_deg"; };
    const YAML::Node written = child(spec.properties, "datum");
    const std::string path = spec.path() + ".properties.datum";
    const bool is_misread = spec_.datum && std::isnan(spec_.datum->latitude_deg);
    if (spec_.datum) origin_.emplace(*spec_.datum, "datum");
    for (PropertiesBase* properties : task.properties()) {
        if (std::ranges::none_of(properties->list(), has)) continue;
        if (is_misread) return unreliable_.push_back(&task);
        if (!written.IsDefined() || written.IsNull()) {
            if (spec_.datum) properties->set("datum", flowYaml(*spec_.datum));
            continue;
        }
        types::Datum own;
        ConfigReader(spec_.file).read(written, path, own);  // without error, as the task has read it
        if (!origin_) origin_.emplace(own, path);
        if (!isSamePlace(own, origin_->first))
            report(written, path,
                   fmt::format("is {}, and {} is {}; a world has one origin: give only the deployment's datum",
                               text(own), origin_->second, text(origin_->first)));
    }
}

void Wiring::connect() {
    std::vector<std::string> made;
    for (const ConnectionSpec& connection : spec_.connections) {
        const std::string text = connection.from + ">" + connection.to;
        if (std::find(made.begin(), made.end(), text) != made.end())
            report(connection.place, connection.path, "is given twice: " + text);
        else
            connectOne(connection);
        made.push_back(text);
    }
}

void Wiring::connectOne(const ConnectionSpec& connection) {
    OutputPortBase* from = findOutput(connection);
    if (!from) {
        findTask(connection, "to", connection.to);  // reports an unknown task here as well
        return;
    }
    InputPortBase* to = findInput(connection, *from);
    if (!to) return;
    if (&from->owner() == &to->owner())
        return report(connection.place, connection.path, "connects " + from->owner().name() + " with itself");
    if (!from->content().empty() && !to->content().empty() && from->content() != to->content())
        return report(connection.place, connection.path,
                      fmt::format("{} gives {}, {} takes {}; the contents must match", from->path(), from->content(),
                                  to->path(), to->content()));
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
        std::vector<std::string> known = getNames(task->outputs());
        std::ranges::copy(aliasesOfPorts(*spec_.task(task->name()), true), std::back_inserter(known));
        report(place, connection.path + ".from",
               fmt::format("{} has no output port {}; {}", task->name(), name, suggestion(name, known)));
    } catch (const ReportedByCheck&) {  // by checkTasks()
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
        std::vector<std::string> known = getNames(task->inputs());
        std::ranges::copy(aliasesOfPorts(*spec_.task(task->name()), false), std::back_inserter(known));
        report(place, connection.path + ".to",
               fmt::format("{} has no input port {}; {}", task->name(), name, suggestion(name, known)));
    } catch (const ReportedByCheck&) {  // by checkTasks()
    } catch (const std::exception& error) {
        if (!isUnreliable(*task)) report(place, connection.path + ".to", error.what());
    }
    return nullptr;
}

void Wiring::checkTasks() {
    for (const auto& task : graph_.tasks()) {
        const TaskSpec& spec = *spec_.task(task->name());
        checkInputs(*task, spec);
        const size_t before = diagnostics_.size();
        environment_->is_refused = !diagnostics_.empty();
        if (!isUnreliable(*task)) {
            ConfigReader reader(spec_.file, spec_.origins);
            reader.setFallback(spec.place.Mark());
            types::Diagnostics diagnostics;
            try {
                task->check(diagnostics);
            } catch (const std::exception& failure) {
                reader.report(spec.place, spec.path(), "cannot be checked: " + types::getReason(failure));
            } catch (...) {
                reader.report(spec.place, spec.path(), "cannot be checked: an exception without a reason");
            }
            reader.report(spec.properties, spec.path() + ".properties", diagnostics);
            diagnostics_.insert(diagnostics_.end(), reader.diagnostics().begin(), reader.diagnostics().end());
        }
        // A clock source with an error has no next time, which is a consequence.
        const bool has_no_time = diagnostics_.size() > before && dynamic_cast<const ClockSource*>(task.get());
        checkActivity(*task, spec, has_no_time);
    }
}

void Wiring::checkInputs(const TaskContext& task, const TaskSpec& spec) {
    // A failed connection has been reported; do not also report that its port is unconnected.
    const auto meant = [&](const InputPortBase& port) {
        const auto& all = spec_.connections;
        return std::any_of(all.begin(), all.end(), [&](const auto& c) { return c.to == port.path(); });
    };
    for (const InputPortBase* port : task.inputs())
        if (port->need() == Need::Required && !port->connected() && !meant(*port))
            consequence(spec.place, spec.path(),
                        fmt::format("input port {} ({}) is not connected; it must be", port->name(), port->typeName()));
}

void Wiring::checkActivity(TaskContext& task, const TaskSpec& spec, bool has_no_time) {
    const YAML::Node place = child(spec.place, "activity");
    for (const std::string& name : spec.activity.trigger)
        if (!task.input(name))
            report(place, spec.path() + ".activity.trigger",
                   "there is no input port " + name + "; " + suggestion(name, getNames(task.inputs())));
    const bool is_misread = std::ranges::any_of(spec_.diagnostics, [&](const types::Diagnostic& diagnostic) {
        return diagnostic.path.starts_with(spec.path() + ".activity");
    });
    if (!is_misread && !has_no_time && !child(place, "period").IsDefined() && !hasCycles(task, spec))
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
               loop->text() + " closes a loop without a buffer; give one of its connections a buffer");
    }
    graph_.arrange();
}

}  // namespace insonify::framework
