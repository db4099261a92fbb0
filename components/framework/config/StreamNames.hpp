#pragma once
// Names of ports' samples and tasks' properties outside of their deployment: in logs.
#include <map>
#include <string>
#include <vector>

#include "components/framework/Port.hpp"

namespace insonify::framework {

/** The name of a stream, "task.object", and the kind of its task. */
struct StreamName {
    std::string task, object;
    std::string model;  ///< As TaskSpec::model(); empty: unknown.
    std::string path() const { return object.empty() ? task : task + "." + object; }
};

/** A task whose output ports replace those of other tasks, as a second base. */
class StandIn {
public:
    virtual ~StandIn() = default;

    /** Returns the stream "task.port" that a port replaces. */
    virtual std::string getStream(const std::string& port) const = 0;
    /** Returns the kind of the task whose port is replaced; empty: unknown. */
    virtual std::string getModel(const std::string& port) const = 0;
};

/** Returns the name of the stream that the port replaces; else the first alias of the port, else its own name. */
StreamName streamName(const OutputPortBase& port);

/** Returns TaskSpec::model() of each task, by name, in the deployment of a task; empty outside of a deployment. */
std::map<std::string, std::string> taskModels(const TaskContext& task);

/** An alias of a property, or of the switch of a block. */
struct PropertyAlias {
    StreamName name;
    std::string task, property;  ///< The alias' target: "head.left_deg" within a block.
    bool is_switch = false;
    bool in_degrees = false;  ///< The property's unit.
};

/** Returns the aliases in the deployment of a task; none outside of a deployment. */
std::vector<PropertyAlias> propertyAliases(const TaskContext& task);

}  // namespace insonify::framework
