#pragma once
#include "components/framework/Deployment.hpp"

namespace insonify::framework {

/** Makes what a DeploymentSpec says: tasks, properties, ports, connections; collects every fault on the way. */
class Wiring {
public:
    Wiring(Deployment& deployment, Registry& registry) : deployment_(deployment), registry_(registry) {}
    /** Throws types::ConfigError with every fault, those of reading the file first. */
    void make(uint64_t seed);

private:
    void loadLibraries();
    void makeTasks();
    void loadProperties(uint64_t seed);
    void seedTask(const TaskContext& task, const TaskSpec& spec, uint64_t seed);
    void connect();
    void connectOne(const ConnectionSpec& connection);
    OutputPortBase* findOutput(const ConnectionSpec& connection);
    InputPortBase* findInput(const ConnectionSpec& connection, OutputPortBase& source);
    TaskContext* findTask(const ConnectionSpec& connection, const char* key, const std::string& port);
    /** Its properties are not to be relied on: ports made on demand and checks would only repeat their faults. */
    bool isFaulty(const TaskContext& task) const;
    void checkTasks();
    void checkInputs(const TaskContext& task, const TaskSpec& spec);
    void checkActivity(TaskContext& task, const TaskSpec& spec);
    void checkLoops();
    types::Diagnostic diagnostic(const YAML::Node& place, const std::string& path, const std::string& message) const;
    void report(const YAML::Node& place, const std::string& path, const std::string& message);
    /** A fault that another one may well have brought about: told after all those. */
    void consequence(const YAML::Node& place, const std::string& path, const std::string& message);

    Deployment& deployment_;
    Registry& registry_;
    types::Diagnostics diagnostics_, consequences_;
    std::vector<const TaskContext*> faulty_;
};

}  // namespace insonify::framework
