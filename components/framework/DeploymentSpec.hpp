#pragma once
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "components/framework/Activity.hpp"
#include "components/framework/ConfigReader.hpp"
#include "components/framework/ConnPolicy.hpp"
#include "types/RosNames.hpp"

namespace insonify::framework {

/** Rock's property files of a task, relative to the deployment file, and the sections to apply, in order. */
struct PropertyFiles {
    std::vector<std::string> files;
    std::vector<std::string> sections{"default"};
    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(types::Field{"files", "", "files of sections, --- name:x"}, self.files);
        visit(types::Field{"sections", "", "those that apply, in order"}, self.sections);
    }
};

struct TaskSpec {
    std::string name, type;
    ActivitySettings activity;
    std::map<std::string, std::string> aliases;   ///< "task.port" or "task.property" by another name for it.
    std::map<std::string, std::string> copies;    ///< "task.property" that takes the value of one of this task as well.
    std::map<std::string, std::string> switches;  ///< "task.property", a block that true puts in and false takes out.
    std::vector<std::string> ignored_properties;  ///< Names that nothing here takes: their values are left out.
    std::set<std::string> left_out;               ///< Those of them that were given a value.
    PropertyFiles property_files;
    YAML::Node properties{YAML::NodeType::Undefined};  ///< From all sources; undefined when there are none.
    YAML::Node place{YAML::NodeType::Undefined};       ///< The task's whole block, for diagnostics.

    std::string path() const { return "tasks." + name; }
    /** What Rock calls its kind: that of its property files, which are named so ("project::Task.yml"), else its type.
     */
    std::string model() const;
    /** Whether a property, or the block that it stands in, is one of `ignored_properties`. */
    bool ignores(const std::string& property) const;
};

struct ConnectionSpec {
    std::string from, to;  ///< "task.port"
    ConnPolicy policy;
    YAML::Node place{YAML::NodeType::Undefined};
    std::string path;  ///< "connections[2]"
};

/** A deployment as written: nothing in it is made or checked against the tasks yet, and all of it may be edited.
 *  Diagnostics of reading are collected, so that Deployment reports them together with its own. */
struct DeploymentSpec {
    std::string file;  ///< As given, for diagnostics.
    std::string text;  ///< The YAML as read.
    bool lockstep = true;
    double start_time = 1;               ///< Of simulated time [s].
    uint64_t seed = 1;                   ///< From which each task without a `seed` of its own gets one, see seedOf.
    double watchdog = 10;                ///< In realtime, how long a cycle may take before it is reported [s].
    bool lock_memory = false;            ///< In realtime, all memory stays resident.
    std::vector<std::string> libraries;  ///< Shared objects, relative to the deployment file.
    types::RosNames names;               ///< What ROS 2 names become in it.
    std::vector<TaskSpec> tasks;         ///< In file order, the order of configuring.
    std::vector<ConnectionSpec> connections;
    Origins origins;  ///< Of properties from elsewhere: property files, aliases, set().
    types::Diagnostics diagnostics;

    /** Throws types::ConfigError when there is no text to be read or it is not YAML; other diagnostics go to
     *  `diagnostics`. */
    static DeploymentSpec load(const std::filesystem::path& file);
    static DeploymentSpec parse(const std::string& text, const std::string& file);

    TaskSpec* task(const std::string& name);  ///< Null when there is none.
    const TaskSpec* task(const std::string& name) const { return const_cast<DeploymentSpec*>(this)->task(name); }
    std::vector<std::string> taskNames() const;
    /** Where "task.port" leads if the task has an alias of that name, else itself. */
    std::string withoutAlias(const std::string& path) const;
    /** The "task.alias" that leads to "task.port" or "task.property", of several the first; empty: none does. */
    std::string aliasOf(const std::string& path) const;
    /** What is written but its schedule leaves out, a line for each task and for the whole; empty: nothing. */
    std::vector<std::string> unused() const;
    /** `task.property.path=value`, the value in YAML: a layer over the file. Of a block only what it names is changed;
     *  null takes a property out. `namespace=auv1` and `frame_prefix=auv1` are those of the deployment. Diagnostics go
     *  to `diagnostics`. */
    void set(const std::string& assignment);
    /** The same for `task.property.path` and a value from elsewhere, whose file and place diagnostics name. */
    void set(const std::string& property, const YAML::Node& value, const Origin& origin);
};

/** "camera.image" -> {"camera", "image"}: split at the first dot; the second is empty when there is none. */
std::pair<std::string, std::string> splitPort(const std::string& path);

/** What a deployment file may say, from the descriptions that it is read by: the keys of the document, of a task and of
 *  a connection, as `describe` lists properties. */
struct DeploymentKeys {
    std::vector<PropertyInfo> document, task, connection;
};
DeploymentKeys deploymentKeys();

}  // namespace insonify::framework
