#include "components/framework/config/DeploymentSpec.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/framework/config/PropertySources.hpp"
#include "components/framework/config/YamlText.hpp"

namespace insonify::framework {
namespace {

enum class Schedule { Lockstep, Realtime };
enum class Scheduler { Other, Fifo };

// The keys of a deployment, described like any other configuration.

struct ActivityKeys {
    std::optional<double> period;
    std::vector<std::string> trigger;
    Scheduler scheduler = Scheduler::Other;
    std::optional<int> priority;
    std::vector<uint32_t> cpus;
    std::optional<double> deadline, watchdog;
    static void describe(auto& self, auto& visit) {
        visit({"period", "s", "time between two cycles", 1e-6, 1e6}, self.period);
        visit({"trigger", "", "input ports whose samples run a cycle"}, self.trigger);
        visit({"scheduler", "", "in realtime, the system's scheduler of the thread"}, self.scheduler);
        visit({"priority", "1", "with scheduler: fifo", 1, 99}, self.priority);
        visit({"cpus", "", "in realtime, processors that the thread may run on", 0, 1023}, self.cpus);
        visit(
            {"deadline", "s", "max time from a sample's stamp to its writing; later samples count as late", 1e-6, 1e6},
            self.deadline);
        visit({"watchdog", "s", "in realtime, max duration of a cycle before it is reported", 1e-3, 1e6},
              self.watchdog);
    }
    void check(types::Diagnostics& diagnostics) const {
        if (period && !trigger.empty())
            diagnostics.push_back({"", "has both period and trigger; a task is either periodic or triggered"});
        if (scheduler == Scheduler::Fifo && !priority)
            diagnostics.push_back({"", "has no priority; scheduler: fifo needs one, from 1 to 99"});
        if (scheduler == Scheduler::Other && priority)
            diagnostics.push_back({"priority", "has no effect with scheduler: other; use scheduler: fifo"});
    }
    ActivitySettings settings() const {
        return {period.value_or(0),   trigger, scheduler == Scheduler::Fifo,
                priority.value_or(0), cpus,    deadline.value_or(0),
                watchdog.value_or(0)};
    }
};

struct TaskKeys {
    std::string type;
    ActivityKeys activity;
    std::map<std::string, std::string> aliases, copies, switches;
    std::vector<std::string> ignored_properties;
    PropertyFiles property_files;
    YAML::Node properties{YAML::NodeType::Undefined};
    static void describe(auto& self, auto& visit) {
        visit({"type", "", "registered type of the task"}, self.type);
        visit({"activity", "", "when it runs"}, self.activity);
        visit({"aliases", "", "other names of ports and properties, with their targets"}, self.aliases);
        visit({"copies", "", "properties whose value another property also gets: its path"}, self.copies);
        visit({"switches", "", "booleans: the block that true inserts and false removes"}, self.switches);
        visit({"ignored_properties", "", "names in its configuration that are not used here and omitted"},
              self.ignored_properties);
        visit({"property_files", "", "its configuration in Rock's files"}, self.property_files);
        visit({"properties", "", "its configuration"}, self.properties);
    }
    void check(types::Diagnostics& diagnostics) const {
        if (type.empty()) diagnostics.push_back({"", "has no type; a task needs one, such as type: scene::SceneTask"});
    }
};

struct PolicyKeys {
    ConnPolicy::Type type = ConnPolicy::Data;
    std::optional<uint32_t> size;
    bool init = false;
    static void describe(auto& self, auto& visit) {
        visit({"type", "", "how samples wait"}, self.type);
        visit({"size", "1", "capacity of a buffer", 1, 1e6}, self.size);
        visit({"init", "1", "hand over the writer's last sample on connecting"}, self.init);
    }
    void check(types::Diagnostics& diagnostics) const {
        if (type == ConnPolicy::Data && size)
            diagnostics.push_back({"size", "has no effect with type: data; use a buffer"});
        if (type != ConnPolicy::Data && !size) diagnostics.push_back({"", "has no size; a buffer needs one"});
    }
};

struct ConnectionKeys {
    std::string from, to;
    PolicyKeys policy;
    static void describe(auto& self, auto& visit) {
        visit({"from", "", "output port, task.port"}, self.from);
        visit({"to", "", "input port, task.port"}, self.to);
        visit({"policy", "", "how samples wait"}, self.policy);
    }
    void check(types::Diagnostics& diagnostics) const {
        for (const auto& [key, path] : {std::pair("from", from), std::pair("to", to)})
            if (splitPort(path).second.empty()) diagnostics.push_back({key, "is \"" + path + "\"; must be task.port"});
    }
};

constexpr const char *wanted_namespace =
                         "; must be words of letters, digits and _, none beginning with a digit, as auv1",
                     *wanted_prefix = "; must be words of letters, digits and _ without a leading slash, as auv1";

struct DocumentKeys {
    Schedule schedule = Schedule::Lockstep;
    double start_time = 1, watchdog = 10;
    uint64_t seed = 1;
    std::optional<types::Datum> datum;
    bool lock_memory = false;
    std::string ros_namespace, frame_prefix;
    std::vector<std::string> libraries;
    YAML::Node tasks{YAML::NodeType::Undefined};
    YAML::Node connections{YAML::NodeType::Undefined};
    static void describe(auto& self, auto& visit) {
        visit({"schedule", "", "simulated time or the wall clock"}, self.schedule);
        visit({"start_time", "s", "start of simulated time", 0, 4e9}, self.start_time);
        visit({"seed", "1", "a task without a seed gets a hash of this one and its name"}, self.seed);
        visit({"datum", "", "the place on the earth that is the world's origin: x is true north there, z up"},
              self.datum);
        visit({"watchdog", "s", "in realtime, max duration of a cycle before it is reported", 1e-3, 1e6},
              self.watchdog);
        visit({"lock_memory", "", "in realtime, all memory stays resident"}, self.lock_memory);
        visit({"namespace", "", "namespace of ROS 2 topics and nodes whose names have no leading slash, /auv1"},
              self.ros_namespace);
        visit({"frame_prefix", "", "prefix of ROS 2 frames except those of the world, auv1 for auv1/base_link"},
              self.frame_prefix);
        visit({"libraries", "", "shared objects with more task types"}, self.libraries);
        visit({"tasks", "", "by name"}, self.tasks);
        visit({"connections", "", "from, to, policy"}, self.connections);
    }
    void check(types::Diagnostics& diagnostics) const {
        types::RosNames names;
        if (!names.setNamespace(ros_namespace))
            diagnostics.push_back({"namespace", "is " + ros_namespace + wanted_namespace});
        if (!names.setFramePrefix(frame_prefix))
            diagnostics.push_back({"frame_prefix", "is " + frame_prefix + wanted_prefix});
        if (!tasks.IsDefined() || tasks.IsNull() || (tasks.IsMap() && tasks.size() == 0))
            diagnostics.push_back({"tasks", "is empty; a deployment needs a task"});
    }
};

YAML::Node readDocument(const std::string& text, const std::string& file) {
    const std::vector<YAML::Node> documents = parseYaml(text, file);
    if (documents.empty() || documents[0].IsNull())
        throw types::ConfigError(file, "", "is empty; a deployment needs tasks");
    if (documents.size() > 1) throw types::ConfigError(file, "", "holds several YAML documents; must be one");
    return documents[0];
}

void readTask(ConfigReader& reader, const YAML::Node& name, const YAML::Node& block, DeploymentSpec& spec) {
    TaskSpec task;
    task.name = name.Scalar();
    task.place.reset(block);
    if (task.name.empty() || task.name.find('.') != std::string::npos)
        reader.report(name, task.path(), "is not a name for a task; must not be empty or contain a dot");
    TaskKeys keys;
    reader.read(block, task.path(), keys);
    task.type = keys.type;
    task.activity = keys.activity.settings();
    task.aliases = keys.aliases;
    task.copies = keys.copies;
    task.switches = keys.switches;
    task.ignored_properties = keys.ignored_properties;
    task.property_files = keys.property_files;
    task.properties.reset(keys.properties);
    spec.tasks.push_back(std::move(task));
}

void readTasks(ConfigReader& reader, const YAML::Node& tasks, DeploymentSpec& spec) {
    if (!tasks.IsDefined()) return;
    reader.isMap(tasks, "tasks", "{NAME: {type: TYPE}}");  // reports two tasks of one name
    if (!tasks.IsMap()) return;
    for (const auto& entry : tasks)
        if (entry.first.IsScalar() && !spec.task(entry.first.Scalar()))
            readTask(reader, entry.first, entry.second, spec);
}

void readConnections(ConfigReader& reader, const YAML::Node& connections, DeploymentSpec& spec) {
    if (!connections.IsDefined() || connections.IsNull() ||
        !reader.isSequence(connections, "connections", ", such as [{from: TASK.PORT, to: TASK.PORT}]"))
        return;
    for (size_t i = 0; i < connections.size(); ++i) {
        ConnectionKeys keys;
        const std::string path = "connections[" + std::to_string(i) + "]";
        const YAML::Node block = connections[i];
        if (!reader.read(block, path, keys)) continue;
        for (std::string* port : {&keys.from, &keys.to}) *port = spec.withoutAlias(*port);
        const ConnPolicy policy{keys.policy.type, keys.policy.size.value_or(1), keys.policy.init};
        spec.connections.push_back({keys.from, keys.to, policy, block, path});
    }
}

/** Returns the keys that are given, "scheduler, cpus", from pairs of a key and whether it is given. */
std::string given(std::initializer_list<std::pair<const char*, bool>> keys) {
    std::string names;
    for (const auto& [key, is_given] : keys)
        if (is_given) names += (names.empty() ? "" : ", ") + std::string(key);
    return names;
}

}  // namespace
}  // namespace insonify::framework

template <>
struct insonify::types::EnumNames<insonify::framework::Schedule> {
    static constexpr std::string_view names[] = {"lockstep", "realtime"};
};

template <>
struct insonify::types::EnumNames<insonify::framework::Scheduler> {
    static constexpr std::string_view names[] = {"other", "fifo"};
};

namespace insonify::framework {

DeploymentKeys deploymentKeys() {
    return {listProperties(DocumentKeys{}), listProperties(TaskKeys{}), listProperties(ConnectionKeys{})};
}

std::pair<std::string, std::string> splitPort(const std::string& path) {
    const size_t dot = path.find('.');
    if (dot == std::string::npos) return {path, ""};
    return {path.substr(0, dot), path.substr(dot + 1)};
}

DeploymentSpec DeploymentSpec::load(const std::filesystem::path& file) {
    return parse(readFile(file, "a deployment file"), file.string());
}

DeploymentSpec DeploymentSpec::parse(const std::string& text, const std::string& file) {
    DeploymentSpec spec;
    spec.file = file;
    spec.text = text;
    const YAML::Node document = readDocument(text, file);
    ConfigReader reader(file);
    DocumentKeys keys;
    reader.read(document, "", keys);
    spec.lockstep = keys.schedule == Schedule::Lockstep;
    spec.start_time = keys.start_time;
    spec.seed = keys.seed;
    spec.datum = keys.datum;
    for (const types::Diagnostic& diagnostic : reader.diagnostics())
        if (diagnostic.path.starts_with("datum")) spec.datum = types::Datum{};
    spec.watchdog = keys.watchdog;
    spec.lock_memory = keys.lock_memory;
    spec.libraries = keys.libraries;
    spec.library_list.reset(child(document, "libraries"));
    spec.names.setNamespace(keys.ros_namespace);
    spec.names.setFramePrefix(keys.frame_prefix);
    readTasks(reader, keys.tasks, spec);
    // Without the key `tasks` each connection would name an unknown task.
    if (keys.tasks.IsDefined()) readConnections(reader, keys.connections, spec);
    spec.diagnostics = reader.diagnostics();
    PropertySources(spec).apply();
    return spec;
}

TaskSpec* DeploymentSpec::task(const std::string& name) {
    const auto found =
        std::find_if(tasks.begin(), tasks.end(), [&](const TaskSpec& task) { return task.name == name; });
    return found == tasks.end() ? nullptr : &*found;
}

std::string TaskSpec::model() const {
    if (property_files.files.empty()) return type;
    const std::string stem = std::filesystem::path(property_files.files.front()).stem().string();
    return stem.find("::") == std::string::npos ? type : stem;
}

bool TaskSpec::ignores(const std::string& property) const {
    return std::ranges::any_of(ignored_properties, [&](const std::string& ignored) {
        return property == ignored || property.starts_with(ignored + ".");
    });
}

std::string DeploymentSpec::withoutAlias(const std::string& path) const {
    const auto [name, port] = splitPort(path);
    const TaskSpec* const owner = task(name);
    const auto alias = owner ? owner->aliases.find(port) : std::map<std::string, std::string>::const_iterator();
    return owner && alias != owner->aliases.end() ? alias->second : path;
}

std::string DeploymentSpec::getAlias(const std::string& path) const {
    for (const TaskSpec& owner : tasks)
        for (const auto& [name, target] : owner.aliases)
            if (target == path) return owner.name + "." + name;
    return "";
}

std::vector<std::string> DeploymentSpec::taskNames() const {
    std::vector<std::string> all;
    for (const TaskSpec& task : tasks) all.push_back(task.name);
    return all;
}

std::vector<std::string> DeploymentSpec::unused() const {
    static const DeploymentSpec usual;
    std::vector<std::string> lines;
    for (const TaskSpec& task : tasks)
        if (!task.omitted.empty())
            lines.push_back(task.name +
                            ": omitted by ignored_properties: " + fmt::format("{}", fmt::join(task.omitted, ", ")));
    const auto note = [&](const std::string& whose, const std::string& keys) {
        if (!keys.empty()) lines.push_back(whose + "not used in " + (lockstep ? "lockstep: " : "realtime: ") + keys);
    };
    if (!lockstep) {
        note("", given({{"start_time", start_time != usual.start_time}}));
        return lines;
    }
    note("", given({{"watchdog", watchdog != usual.watchdog}, {"lock_memory", lock_memory}}));
    for (const TaskSpec& task : tasks) {
        const ActivitySettings& a = task.activity;
        note(task.name + ": ", given({{"scheduler", a.fifo},
                                      {"cpus", !a.cpus.empty()},
                                      {"deadline", a.deadline > 0},
                                      {"watchdog", a.watchdog > 0}}));
    }
    return lines;
}

void DeploymentSpec::set(const std::string& assignment) {
    const size_t equals = assignment.find('=');
    const std::string property = assignment.substr(0, equals);
    const Origin origin{set_origin, assignment};
    const auto refuse = [&](const std::string& why) { diagnostics.push_back({assignment, why, set_origin}); };
    if (equals == std::string::npos) return refuse("must be task.property=value");
    if (equals + 1 == assignment.size()) return refuse("has no value; null removes the property");
    try {
        set(property, parseValue(assignment.substr(equals + 1)), origin);
    } catch (const types::ConfigError& error) {
        refuse(error.diagnostics().front().message);
    }
}

void DeploymentSpec::set(const std::string& property, const YAML::Node& value, const Origin& origin) {
    const auto refuse = [&](const std::string& why) {
        types::Diagnostic diagnostic{origin.path, why, origin.file};
        if (!origin.mark.is_null())
            diagnostic = {origin.path, why, origin.file, origin.mark.line + 1, origin.mark.column + 1};
        diagnostics.push_back(diagnostic);
    };
    const std::string written = value.IsScalar() ? value.Scalar() : "";
    if (property == "namespace" || property == "frame_prefix") {
        const bool is_namespace = property == "namespace";
        if (!(value.IsNull() || value.IsScalar()) ||
            !(is_namespace ? names.setNamespace(written) : names.setFramePrefix(written)))
            refuse("is " + written + (is_namespace ? wanted_namespace : wanted_prefix));
        return;
    }
    const auto [name, rest] = splitPort(property);
    if (rest.empty()) return refuse("must be task.property=value, namespace=value or frame_prefix=value");
    TaskSpec* changed = task(name);
    if (!changed) return refuse("there is no task " + name + "; " + suggestion(name, taskNames()));
    if (rest == "activity" || rest.starts_with("activity."))
        return refuse("is no property: an activity can only be changed in the deployment");
    try {
        PropertySources(*this).set(*changed, rest, value, origin);
    } catch (const types::ConfigError& error) {
        refuse(error.diagnostics().front().message);
    }
}

}  // namespace insonify::framework
