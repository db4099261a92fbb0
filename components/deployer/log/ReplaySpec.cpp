#include "components/deployer/log/ReplaySpec.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Pipeline.hpp"
#include "types/samples/Range.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::deployer {
namespace {

using framework::ConnectionSpec;
using framework::DeploymentSpec;
using framework::splitPort;
using framework::TaskSpec;

/** Whether a stream has the samples of a port, not the values of a property. */
bool isOfPort(const log::Stream& stream) {
    const auto type = stream.metadata.find("rock_stream_type");
    return type == stream.metadata.end() || type->second == "port";
}

/** Returns the tasks of the deployment that have a stream in the log, under any of their names. */
std::set<std::string> loggedTasks(const log::Reader& log, const DeploymentSpec& spec) {
    std::set<std::string> names;
    for (const log::Stream& stream : log.streams())
        if (const std::string task = findWriter(spec, stream.name); isOfPort(stream) && spec.task(task))
            names.insert(task);
    return names;
}

std::set<std::string> replacedTasks(const log::Reader& log, const DeploymentSpec& spec, bool rerender) {
    std::set<std::string> names = loggedTasks(log, spec);
    if (rerender) {
        framework::Registry registry = coreTasks();
        for (const std::string& task : pingTasks(spec, registry)) names.erase(task);
    }
    if (names.empty())
        throw types::ConfigError(log.path(), "",
                                 std::string("none of its streams is of a task of ") + spec.file +
                                     (rerender ? " before its sonars" : "") + "; --pose takes only its poses");
    return names;
}

/** Connects each sonar to the log's poses of its pings. */
void drivePings(DeploymentSpec& spec, const log::Reader& log, const std::string& replay) {
    for (TaskSpec& task : spec.tasks) {
        const std::string stream = poseStream(log, task.name);
        if (stream.empty() || !task.type.starts_with("sonar::")) continue;
        ConnectionSpec connection;
        connection.from = replay + "." + stream;
        connection.to = task.name + ".given_pose";
        connection.policy = framework::ConnPolicy::buffer(256);
        spec.connections.push_back(connection);
        task.activity.trigger = {"given_pose"};
    }
}

/** Returns `name`, with "_" added until no task has it. */
std::string freeName(const DeploymentSpec& spec, std::string name) {
    while (spec.task(name)) name += "_";
    return name;
}

std::string_view getName(types::WorldFrame frame) {
    return types::EnumNames<types::WorldFrame>::names[static_cast<size_t>(frame)];
}

TaskSpec replayTask(const std::string& name, const ReplayOptions& options) {
    TaskSpec task;
    task.name = name;
    task.type = "replay::ReplayTask";
    task.properties = YAML::Node(YAML::NodeType::Map);
    task.properties["file"] = std::filesystem::absolute(options.log).string();
    task.properties["from"] = options.from;
    task.properties["loop"] = options.loop;
    task.properties["world_frame"] = std::string(getName(options.world_frame));
    for (const log::PoseSource& source : options.poses) {
        YAML::Node node;
        node["source"] = source.source;
        node["stream"] = source.stream;
        node["orientation"] = source.orientation;
        if (source.datum) {
            node["datum"]["latitude_deg"] = source.datum->latitude_deg;
            node["datum"]["longitude_deg"] = source.datum->longitude_deg;
            node["datum"]["height_m"] = source.datum->height_m;
        }
        task.properties["poses"].push_back(node);
    }
    return task;
}

/** Returns the stream of a port in a log, under its alias or its own name; empty: there is none. */
std::string getStream(const log::Reader& log, const DeploymentSpec& spec, const std::string& port) {
    const std::string alias = spec.getAlias(port);
    return !alias.empty() && log.find(alias) ? alias : log.find(port) ? port : "";
}

/** Returns the connections, with logged ports replaced by those of the replay. Omits connections to replaced tasks, and
 *  from replaced tasks' ports that have no stream in the log. */
std::vector<ConnectionSpec> reconnected(const DeploymentSpec& spec, const log::Reader& log,
                                        const std::set<std::string>& replaced, const std::string& replay) {
    std::vector<ConnectionSpec> connections;
    for (const ConnectionSpec& written : spec.connections) {
        const bool from_log = replaced.contains(splitPort(written.from).first);
        const std::string stream = from_log ? getStream(log, spec, written.from) : "";
        if (replaced.contains(splitPort(written.to).first) || (from_log && stream.empty())) continue;
        connections.push_back(written);
        if (from_log) connections.back().from = replay + "." + stream;
    }
    return connections;
}

/** Adds tasks between others that get no input any more: their writers are replaced, and the log lacks the writers'
 *  samples. */
void addDeaf(const DeploymentSpec& spec, const log::Reader& log, std::set<std::string>& replaced) {
    const auto receives = [&](const ConnectionSpec& connection) {
        return !replaced.contains(splitPort(connection.from).first) || !getStream(log, spec, connection.from).empty();
    };
    const auto isDeaf = [&](const TaskSpec& task) {
        bool reads = false, writes = false, has_reader = false;
        for (const ConnectionSpec& connection : spec.connections) {
            writes |= splitPort(connection.from).first == task.name;
            if (splitPort(connection.to).first != task.name) continue;
            reads = true;
            has_reader |= receives(connection);
        }
        return reads && writes && !has_reader;
    };
    for (size_t before = 0; before != replaced.size();) {
        before = replaced.size();
        for (const TaskSpec& task : spec.tasks)
            if (!replaced.contains(task.name) && isDeaf(task)) replaced.insert(task.name);
    }
}

/** Gives the altitudes of an imported recording to tasks for pictures and files of a side-scan that read no
 *  altimeter. */
void connectAltitudes(DeploymentSpec& spec, const log::Reader& log, const std::string& replay) {
    const auto isRecorded = [](const log::Stream& stream) {
        return stream.holds<types::Range>() && !stream.metadatum("insonify_recording").empty();
    };
    const auto altitudes = std::ranges::find_if(log.streams(), isRecorded);
    if (altitudes == log.streams().end()) return;
    for (const TaskSpec& task : spec.tasks) {
        const std::string port = task.name + ".altitude";
        const bool is_read = std::ranges::count(spec.connections, port, &ConnectionSpec::to) > 0;
        const bool reads_altitudes = task.type == "output::SideScanImageTask" || task.type == "output::XtfTask";
        if (!reads_altitudes || is_read) continue;
        ConnectionSpec connection;
        connection.from = replay + "." + altitudes->name;
        connection.to = port;
        connection.policy = framework::ConnPolicy::buffer(256);
        spec.connections.push_back(connection);
    }
}

/** Throws for scanning sonars, because a log does not record the head's bearing at `from`, unless it has the requests
 * of a driver. */
void refuseScansFrom(const DeploymentSpec& spec, const log::Reader& log, double from) {
    const auto isDriven = [&](const TaskSpec& task) {
        return std::ranges::any_of(spec.connections, [&](const ConnectionSpec& connection) {
            return connection.to == task.name + ".settings" && !getStream(log, spec, connection.from).empty();
        });
    };
    for (const TaskSpec& task : spec.tasks)
        if (from > 0 && task.type == "sonar::ScanningSonarTask" && !isDriven(task))
            throw types::ConfigError(spec.file, task.path(),
                                     "is a scanning sonar, whose head starts at its left limit: rendered again with "
                                     "--from it would look in other directions than in the log; omit --from");
}

}  // namespace

DeploymentSpec replaying(DeploymentSpec spec, const log::Reader& log, const ReplayOptions& options) {
    if (options.rerender) refuseScansFrom(spec, log, options.from);
    std::set<std::string> replaced = replacedTasks(log, spec, options.rerender);
    if (!options.outside) replaced.merge(outsideTasks(spec));
    if (!options.rerender) addDeaf(spec, log, replaced);
    const std::string name = freeName(spec, "replay");
    // New lists, because assigning a YAML node would change its other references.
    std::vector<TaskSpec> tasks{replayTask(name, options)};
    for (const TaskSpec& task : spec.tasks)
        if (!replaced.contains(task.name)) tasks.push_back(task);
    std::vector<ConnectionSpec> connections = reconnected(spec, log, replaced, name);
    spec.tasks.swap(tasks);
    spec.connections.swap(connections);
    if (options.rerender && options.poses.empty()) drivePings(spec, log, name);
    connectAltitudes(spec, log, name);
    spec.lockstep = true;
    return spec;
}

std::vector<std::string> bodyPorts(const DeploymentSpec& spec) {
    std::vector<std::string> ports;
    for (const ConnectionSpec& connection : spec.connections) {
        const auto [task, port] = splitPort(connection.to);
        const TaskSpec* const scene = spec.task(task);
        if (!scene || port != "pose" || scene->type != "scene::SceneTask") continue;
        const std::string alias = spec.getAlias(connection.from);
        const std::string& name = alias.empty() ? connection.from : alias;
        if (std::ranges::find(ports, name) == ports.end()) ports.push_back(name);
    }
    return ports;
}

bool hasStream(const DeploymentSpec& spec, const log::Reader& log) { return !loggedTasks(log, spec).empty(); }

std::set<std::string> outsideTasks(const DeploymentSpec& spec) {
    framework::Registry registry = coreTasks();
    if (types::Diagnostics wrong = registry.loadLibraries(spec, std::filesystem::path(spec.file).parent_path());
        !wrong.empty())
        throw types::ConfigError(std::move(wrong));
    std::set<std::string> names;
    for (const TaskSpec& task : spec.tasks)
        if (const auto made = registry.make(task.type, task.name); made && made->reachesOutside())
            names.insert(task.name);
    return names;
}

std::string poseStream(const log::Reader& log, const std::string& sonar) {
    const log::Stream* const stream = log.find(sonar + ".pose");
    return stream && isOfPort(*stream) && stream->holds<types::Pose>() && stream->count > 0 ? stream->name : "";
}

std::vector<std::string> pingStreams(const log::Reader& log, const DeploymentSpec& spec) {
    std::vector<std::string> names;
    for (const log::Stream& stream : log.streams())
        if (stream.holds<types::Sonar>() && spec.task(findWriter(spec, stream.name))) names.push_back(stream.name);
    return names;
}

std::string findWriter(const DeploymentSpec& spec, const std::string& stream) {
    return splitPort(spec.withoutAlias(stream)).first;
}

void addLogger(DeploymentSpec& spec, const std::vector<std::string>& ports, const std::string& file) {
    TaskSpec task;
    task.name = freeName(spec, "rerendered");
    task.type = "logger::LoggerTask";
    task.properties = YAML::Node(YAML::NodeType::Map);
    task.properties["file"] = file;
    spec.tasks.push_back(task);
    for (const std::string& port : ports) {
        ConnectionSpec connection;
        connection.from = spec.withoutAlias(port);
        connection.to = task.name + "." + port;
        connection.policy = framework::ConnPolicy::buffer(256);
        spec.connections.push_back(connection);
    }
}

}  // namespace insonify::deployer
