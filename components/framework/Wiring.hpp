#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "components/framework/Graph.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/config/DeploymentSpec.hpp"

namespace insonify::framework {

/** Makes the Graph of a DeploymentSpec (tasks, properties, ports, connections) and collects every diagnostic on the
 *  way. */
class Wiring {
public:
    /** All tasks share `environment`. */
    Wiring(DeploymentSpec& spec, std::shared_ptr<Environment> environment, Registry& registry)
        : spec_(spec), environment_(std::move(environment)), registry_(registry) {}
    /** Makes the graph, once. Throws types::ConfigError with every diagnostic, those of reading the file first. */
    Graph make(uint64_t seed);

private:
    void loadLibraries();
    void makeTasks();
    std::unique_ptr<TaskContext> makeTask(const TaskSpec& spec);
    std::string otherOwners(const std::string& key) const;
    void loadProperties(uint64_t seed);
    /** Returns the aliases and switches of a task that lead to properties, or to ports. */
    std::vector<std::string> aliasesOfProperties(const TaskSpec& spec) const;
    std::vector<std::string> aliasesOfPorts(const TaskSpec& spec, bool outputs) const;
    YAML::Node withoutUnknown(const TaskContext& task, const TaskSpec& spec, ConfigReader& reader) const;
    /** Sets the `seed` of a task that has this property: from `seed`, else from the deployment's unless a seed is
     *  written. A seed given by --set stays. */
    void seedTask(const TaskContext& task, const TaskSpec& spec, uint64_t seed);
    /** Sets the `datum` of a task that has this property to the deployment's, unless one is written. Reports one that
     * is another place than the deployment's or than that of a task before. */
    void placeTask(const TaskContext& task, const TaskSpec& spec);
    void connect();
    void connectOne(const ConnectionSpec& connection);
    OutputPortBase* findOutput(const ConnectionSpec& connection);
    InputPortBase* findInput(const ConnectionSpec& connection, OutputPortBase& source);
    TaskContext* findTask(const ConnectionSpec& connection, const char* key, const std::string& port);
    /** Whether the task's properties are unreliable: dynamic ports and checks would only repeat their diagnostics. */
    bool isUnreliable(const TaskContext& task) const;
    void checkTasks();
    void checkInputs(const TaskContext& task, const TaskSpec& spec);
    void checkActivity(TaskContext& task, const TaskSpec& spec, bool has_no_time);
    /** Whether something runs the task, or would if its connections were correct. */
    bool hasCycles(const TaskContext& task, const TaskSpec& spec) const;
    void checkLoops();
    types::Diagnostic diagnostic(const YAML::Node& place, const std::string& path, const std::string& message) const;
    void report(const YAML::Node& place, const std::string& path, const std::string& message);
    /** Reports a diagnostic that may follow from another one; it is listed after all primary diagnostics. */
    void consequence(const YAML::Node& place, const std::string& path, const std::string& message);

    DeploymentSpec& spec_;
    std::shared_ptr<Environment> environment_;
    Registry& registry_;
    Graph graph_;
    types::Diagnostics diagnostics_, consequences_;
    bool lacks_libraries_ = false;  ///< Some of `libraries` cannot be loaded.
    std::vector<const TaskContext*> unreliable_;
    std::optional<std::pair<types::Datum, std::string>> origin_;  ///< The datum of all tasks, and where it is written.
};

/** Returns the seed of a task, from that of the deployment or of `run --seed`: stable over runs, machines and versions;
 *  below 2^53. */
uint64_t computeSeed(uint64_t seed, const std::string& task);

}  // namespace insonify::framework
