#pragma once
// What a port's samples and a task's properties are called outside of their deployment: in logs.
#include <map>
#include <string>
#include <vector>

#include "components/framework/Port.hpp"

namespace insonify::framework {

/** Whose a stream is: "task.object", and what kind of task that is. */
struct StreamName {
    std::string task, object;
    std::string model;  ///< As TaskSpec::model(); empty: it is not known.
    std::string path() const { return object.empty() ? task : task + "." + object; }
};

/** A task whose output ports stand for those of others: a second base. */
class StandIn {
public:
    virtual ~StandIn() = default;

    /** The stream that a port was, "task.port". */
    virtual std::string streamOf(const std::string& port) const = 0;
    /** What is known of the kind of task whose port that was; empty: nothing. */
    virtual std::string modelOf(const std::string& port) const = 0;
};

/** Of a port that stands for another, that one's name; else the first alias that leads to it, else its own. */
StreamName streamNameOf(const OutputPortBase& port);

/** TaskSpec::model() of each task, by its name, of the deployment that a task belongs to; outside of one, none. */
std::map<std::string, std::string> taskModels(const TaskContext& task);

/** Another name of a property, or of the switch of a block. */
struct PropertyAlias {
    StreamName name;
    std::string task, property;  ///< Where it leads: "head.left_deg" within a block.
    bool is_switch = false;
    bool in_degrees = false;  ///< The property's unit.
};

/** Those of the deployment that a task belongs to; of a task outside of one, none. */
std::vector<PropertyAlias> propertyAliases(const TaskContext& task);

}  // namespace insonify::framework
