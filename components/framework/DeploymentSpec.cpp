#include "components/framework/DeploymentSpec.hpp"

#include <yaml-cpp/depthguard.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace insonify::framework {
namespace {

using types::Field;

enum class Schedule { Lockstep, Realtime };

// What the keys of a deployment are, described as any other configuration.

struct ActivityKeys {
    std::optional<double> period;
    std::vector<std::string> trigger;
    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"period", "s", "time between two cycles", 1e-6, 1e6}, self.period);
        visit(Field{"trigger", "", "input ports whose samples run a cycle"}, self.trigger);
    }
    void check(types::Problems& problems) const {
        if (period && !trigger.empty())
            problems.push_back({"", "has both period and trigger; a task is either periodic or triggered"});
    }
};

struct TaskKeys {
    std::string type;
    ActivityKeys activity;
    YAML::Node properties{YAML::NodeType::Undefined};
    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"type", "", "registered type of the task"}, self.type);
        visit(Field{"activity", "", "when it runs"}, self.activity);
        visit(Field{"properties", "", "its configuration"}, self.properties);
    }
    void check(types::Problems& problems) const {
        if (type.empty()) problems.push_back({"", "has no type; a task needs one, such as type: sonar::SonarTask"});
    }
};

struct PolicyKeys {
    ConnPolicy::Type type = ConnPolicy::Data;
    std::optional<uint32_t> size;
    bool init = false;
    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"type", "", "how samples wait"}, self.type);
        visit(Field{"size", "1", "capacity of a buffer", 1, 1e6}, self.size);
        visit(Field{"init", "1", "hand over the writer's last sample on connecting"}, self.init);
    }
    void check(types::Problems& problems) const {
        if (type == ConnPolicy::Data && size)
            problems.push_back({"size", "is of no use with type: data; buffers have one"});
        if (type != ConnPolicy::Data && !size) problems.push_back({"", "has no size; a buffer needs one"});
    }
};

struct ConnectionKeys {
    std::string from, to;
    PolicyKeys policy;
    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"from", "", "output port, task.port"}, self.from);
        visit(Field{"to", "", "input port, task.port"}, self.to);
        visit(Field{"policy", "", "how samples wait"}, self.policy);
    }
    void check(types::Problems& problems) const {
        for (const auto& [key, path] : {std::pair("from", from), std::pair("to", to)})
            if (splitPort(path).second.empty()) problems.push_back({key, "is \"" + path + "\"; must be task.port"});
    }
};

struct DocumentKeys {
    Schedule schedule = Schedule::Lockstep;
    double start_time = 1;
    std::vector<std::string> libraries;
    YAML::Node tasks{YAML::NodeType::Undefined};
    YAML::Node connections{YAML::NodeType::Undefined};
    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"schedule", "", "simulated time or the wall clock"}, self.schedule);
        visit(Field{"start_time", "s", "start of simulated time", 0, 4e9}, self.start_time);
        visit(Field{"libraries", "", "shared objects with more task types"}, self.libraries);
        visit(Field{"tasks", "", "by name"}, self.tasks);
        visit(Field{"connections", "", "from, to, policy"}, self.connections);
    }
    void check(types::Problems& problems) const {
        if (!tasks.IsDefined() || tasks.size() == 0)
            problems.push_back({"tasks", "is empty; a deployment needs a task"});
    }
};

/** Bytes that cannot be part of UTF-8 text, or a NUL. */
bool isText(std::string_view bytes) {
    size_t following = 0;
    for (const unsigned char c : bytes) {
        if (c == 0 || (following > 0) != ((c & 0xC0) == 0x80)) return false;
        if (following > 0)
            --following;
        else if (c >= 0xF8)
            return false;
        else
            following = c >= 0xF0 ? 3 : c >= 0xE0 ? 2 : c >= 0xC0 ? 1 : 0;
    }
    return following == 0;
}

YAML::Node parseYaml(const std::string& text, const std::string& file) {
    if (!isText(text)) throw types::ConfigError(file, "", "is not text; a deployment is YAML in UTF-8");
    std::vector<YAML::Node> documents;
    try {
        documents = YAML::LoadAll(text);
    } catch (const YAML::DeepRecursion& error) {
        throw types::ConfigError({{file, error.mark.line + 1, error.mark.column + 1, "", "is nested too deeply"}});
    } catch (const YAML::Exception& error) {
        throw types::ConfigError({{file, error.mark.line + 1, error.mark.column + 1, "", "is not YAML: " + error.msg}});
    }
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
        reader.fault(name, task.path(), "is no name for a task; must not be empty nor hold a dot");
    TaskKeys keys;
    reader.read(block, task.path(), keys);
    task.type = keys.type;
    task.activity = {keys.activity.period.value_or(0), keys.activity.trigger};
    task.properties.reset(keys.properties);
    spec.tasks.push_back(std::move(task));
}

void readTasks(ConfigReader& reader, const YAML::Node& tasks, DeploymentSpec& spec) {
    if (!tasks.IsDefined()) return;
    reader.isMap(tasks, "tasks");  // finds two tasks of one name
    if (!tasks.IsMap()) return;
    for (const auto& entry : tasks)
        if (entry.first.IsScalar() && !spec.task(entry.first.Scalar()))
            readTask(reader, entry.first, entry.second, spec);
}

void readConnections(ConfigReader& reader, const YAML::Node& connections, DeploymentSpec& spec) {
    if (!connections.IsDefined() || connections.IsNull() || !reader.isSequence(connections, "connections")) return;
    for (size_t i = 0; i < connections.size(); ++i) {
        ConnectionKeys keys;
        const std::string path = "connections[" + std::to_string(i) + "]";
        const YAML::Node block = connections[i];
        if (!reader.read(block, path, keys)) continue;
        const ConnPolicy policy{keys.policy.type, keys.policy.size.value_or(1), keys.policy.init};
        spec.connections.push_back({keys.from, keys.to, policy, block, path});
    }
}

/** A copy of `block` in which the property at `path` is `value`: nodes that an anchor shares must not change together.
 */
YAML::Node assigned(const YAML::Node& block, const std::string& path, const YAML::Node& value) {
    const auto [key, rest] = splitPort(path);
    const YAML::Node old = child(block, key);
    YAML::Node changed(YAML::NodeType::Map);
    if (block.IsDefined() && block.IsMap())
        for (const auto& entry : block)
            if (!entry.first.IsScalar() || entry.first.Scalar() != key) changed.force_insert(entry.first, entry.second);
    changed.force_insert(key, rest.empty() ? value : assigned(old, rest, value));
    return changed;
}

}  // namespace
}  // namespace insonify::framework

template <>
struct insonify::types::EnumNames<insonify::framework::Schedule> {
    static constexpr std::string_view names[] = {"lockstep", "realtime"};
};

namespace insonify::framework {

std::pair<std::string, std::string> splitPort(const std::string& path) {
    const size_t dot = path.find('.');
    if (dot == std::string::npos) return {path, ""};
    return {path.substr(0, dot), path.substr(dot + 1)};
}

DeploymentSpec DeploymentSpec::load(const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error))
        throw types::ConfigError(file.string(), "", "is a directory; must be a deployment file");
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw types::ConfigError(file.string(), "", "cannot be opened; must be a deployment file");
    std::stringstream text;
    text << stream.rdbuf();
    return parse(text.str(), file.string());
}

DeploymentSpec DeploymentSpec::parse(const std::string& text, const std::string& file) {
    DeploymentSpec spec;
    spec.file = file;
    spec.text = text;
    const YAML::Node document = parseYaml(text, file);
    ConfigReader reader(file);
    DocumentKeys keys;
    reader.read(document, "", keys);
    spec.lockstep = keys.schedule == Schedule::Lockstep;
    spec.start_time = keys.start_time;
    spec.libraries = keys.libraries;
    readTasks(reader, keys.tasks, spec);
    readConnections(reader, keys.connections, spec);
    spec.faults = reader.faults();
    return spec;
}

TaskSpec* DeploymentSpec::task(const std::string& name) {
    const auto found =
        std::find_if(tasks.begin(), tasks.end(), [&](const TaskSpec& task) { return task.name == name; });
    return found == tasks.end() ? nullptr : &*found;
}

std::vector<std::string> DeploymentSpec::taskNames() const {
    std::vector<std::string> names;
    for (const TaskSpec& task : tasks) names.push_back(task.name);
    return names;
}

void DeploymentSpec::set(const std::string& assignment) {
    const auto refuse = [&](const std::string& why) { faults.push_back({"--set", 0, 0, assignment, why}); };
    const size_t equals = assignment.find('=');
    const auto [name, property] = splitPort(assignment.substr(0, equals));
    if (equals == std::string::npos || property.empty()) return refuse("must be task.property=value");
    TaskSpec* changed = task(name);
    if (!changed) return refuse("there is no task " + name + "; " + suggestion(name, taskNames()));
    try {
        const std::string value = assignment.substr(equals + 1);
        if (!isText(value)) return refuse("is not UTF-8 text");
        changed->properties.reset(assigned(changed->properties, property, YAML::Load(value)));
        set_paths.push_back(changed->path() + ".properties." + property);
    } catch (const YAML::Exception& error) {
        refuse("is not YAML: " + error.msg);
    }
}

}  // namespace insonify::framework
