#pragma once
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "components/framework/config/ConfigReader.hpp"
#include "components/framework/config/ConnPolicy.hpp"
#include "components/framework/execution/Activity.hpp"
#include "types/geometry/Datum.hpp"
#include "types/text/RosNames.hpp"

namespace insonify::framework {

/** Rock's property files of a task, relative to the deployment file, and the sections to apply, in order. */
struct PropertyFiles {
    std::vector<std::string> files;
    std::vector<std::string> sections{"default"};
    static void describe(auto& self, auto& visit) {
        visit({"files", "", "files of sections, --- name:x"}, self.files);
        visit({"sections", "", "those that apply, in order"}, self.sections);
    }
};

struct TaskSpec {
    std::string name, type;
    ActivitySettings activity;
    std::map<std::string, std::string> aliases;   ///< Targets "task.port" or "task.property", by alias.
    std::map<std::string, std::string> copies;    ///< "task.property" that also gets this property's value.
    std::map<std::string, std::string> switches;  ///< "task.property", a block: true inserts it, false removes it.
    std::vector<std::string> ignored_properties;  ///< Properties without meaning here: their values are omitted.
    std::set<std::string> omitted;                ///< Ignored properties that were given a value.
    PropertyFiles property_files;
    YAML::Node properties{YAML::NodeType::Undefined};  ///< From all sources; undefined when there are none.
    YAML::Node place{YAML::NodeType::Undefined};       ///< The task's whole block, for diagnostics.

    std::string path() const { return "tasks." + name; }
    /** Returns Rock's name of the task's kind: the model of its property files ("project::Task.yml"), else its type. */
    std::string model() const;
    /** Whether a property, or the block that contains it, is in `ignored_properties`. */
    bool ignores(const std::string& property) const;
};

struct ConnectionSpec {
    std::string from, to;  ///< "task.port"
    ConnPolicy policy;
    YAML::Node place{YAML::NodeType::Undefined};
    std::string path;  ///< "connections[2]"
};

/** A deployment as written. Nothing is made or checked against the tasks yet, and every member may be edited.
 *  Diagnostics of reading are collected, so that Deployment reports them together with its own. */
struct DeploymentSpec {
    std::string file;  ///< As given, for diagnostics.
    std::string text;  ///< The YAML as read.
    bool lockstep = true;
    double start_time = 1;               ///< Start of simulated time [s].
    uint64_t seed = 1;                   ///< Source of the seeds of tasks without their own `seed`, see computeSeed.
    std::optional<types::Datum> datum;   ///< Of the world, also of tasks without their own; NaN: misread.
    double watchdog = 10;                ///< In realtime, the max duration of a cycle before it is reported [s].
    bool lock_memory = false;            ///< In realtime, keeps all memory resident.
    std::vector<std::string> libraries;  ///< Shared objects, relative to the deployment file.
    YAML::Node library_list{YAML::NodeType::Undefined};  ///< Their list in the file, for diagnostics.
    types::RosNames names;                               ///< Translation of ROS 2 names in this deployment.
    std::vector<TaskSpec> tasks;                         ///< In file order, the order of configuring.
    std::vector<ConnectionSpec> connections;
    Origins origins;  ///< Sources of properties from elsewhere: property files, aliases, set().
    types::Diagnostics diagnostics;

    /** Reads a deployment file. Throws types::ConfigError if the text cannot be read or is not YAML; other diagnostics
     *  are added to `diagnostics`. */
    static DeploymentSpec load(const std::filesystem::path& file);
    static DeploymentSpec parse(const std::string& text, const std::string& file);

    TaskSpec* task(const std::string& name);  ///< Null when there is none.
    const TaskSpec* task(const std::string& name) const { return const_cast<DeploymentSpec*>(this)->task(name); }
    std::vector<std::string> taskNames() const;
    /** Returns the target of "task.port" if the task has an alias of that name, else the path itself. */
    std::string withoutAlias(const std::string& path) const;
    /** Returns the first "task.alias" of "task.port" or "task.property"; empty: no alias. */
    std::string getAlias(const std::string& path) const;
    /** Returns what is written but unused under this schedule, one line per task and for the whole; empty: nothing. */
    std::vector<std::string> unused() const;
    /** Sets `task.property.path=value`, with the value in YAML, over the file. In a block, only the named values
     *  change; null removes a property. `namespace=auv1` and `frame_prefix=auv1` set those of the deployment.
     *  Diagnostics are added to `diagnostics`. */
    void set(const std::string& assignment);
    /** Sets `task.property.path` to a value from elsewhere; diagnostics name its file and place. */
    void set(const std::string& property, const YAML::Node& value, const Origin& origin);
};

/** Splits at the first dot: "camera.image" -> {"camera", "image"}; the second is empty when there is no dot. */
std::pair<std::string, std::string> splitPort(const std::string& path);

/** The keys that a deployment file may have: of the document, of a task and of a connection. They are taken from the
 *  descriptions that read them, as `describe` lists properties. */
struct DeploymentKeys {
    std::vector<PropertyInfo> document, task, connection;
};
DeploymentKeys deploymentKeys();

}  // namespace insonify::framework
