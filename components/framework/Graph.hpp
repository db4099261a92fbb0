#pragma once
// Properties of the tasks that a task's samples come from.
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/Port.hpp"
#include "components/framework/TaskContext.hpp"
#include "types/ReturnLevels.hpp"
#include "types/samples/Pose.hpp"
#include "types/samples/TaskRecord.hpp"

namespace insonify::framework {

/** A connection between two ports. */
struct Connection {
    OutputPortBase* from;
    InputPortBase* to;
    ConnPolicy policy;
    std::shared_ptr<const ChannelBase> channel;
    std::string text() const { return from->path() + ">" + to->path(); }
};

/** Tasks, the connections between their ports, and the order in which the tasks run. */
class Graph {
public:
    const std::vector<std::unique_ptr<TaskContext>>& tasks() const { return tasks_; }  ///< In the order of add().
    TaskContext* task(const std::string& name) const;                                  ///< Null when there is none.
    const std::vector<Connection>& connections() const { return connections_; }
    /** Writers before readers, otherwise as in tasks(). In a loop, a buffered connection leads backwards. */
    const std::vector<TaskContext*>& order() const { return order_; }
    /** Returns the unbuffered connections that form loops: one for each task on such a loop. */
    std::vector<const Connection*> unbufferedLoops() const;

    TaskContext& add(std::unique_ptr<TaskContext> task);
    /** Connects two ports; false: the types of the ports differ. */
    bool connect(OutputPortBase& from, InputPortBase& to, ConnPolicy policy);
    /** Computes order(), once all connections are made. */
    void arrange();

    /** Returns the number of counted samples (PortBase::counted) that every source of counted samples has written. A
     *  source of counted samples reads none. */
    uint64_t countedSamples() const;
    /** The outputs of the sources of counted samples. */
    const std::vector<const OutputPortBase*>& counted() const { return counted_; }
    /** Returns whether a task is in Exception or FatalError, so that a run must end. */
    bool hasFailed() const;
    /** Returns whether a source of counted samples is in error and thus writes none. */
    bool hasSourceInError() const;

private:
    std::vector<const OutputPortBase*> countedOutputs() const;

    std::vector<std::unique_ptr<TaskContext>> tasks_;
    std::vector<Connection> connections_;
    std::vector<TaskContext*> order_;
    std::vector<const OutputPortBase*> counted_;
};

/** Whether the task is in Exception or FatalError. */
bool hasFailed(const TaskContext& task);

/** Returns the value of a property, or of a path such as "head.left_deg" within a block; none: not present. */
std::optional<types::PropertyValue> valueAt(const types::TaskRecord& task, const std::string& path);

/** Returns the first of these properties that the nearest task upstream of the port has, directly or through others;
 *  none: no task has one. */
std::optional<types::PropertyValue> upstreamValue(const InputPortBase& port, std::initializer_list<const char*> paths);

/** As upstreamValue, for a number. */
std::optional<double> upstreamNumber(const InputPortBase& port, std::initializer_list<const char*> paths);

/** Returns how the samples of a port fall with range: after the nearest ReturnSource upstream, and the receiver
 *  between; the defaults where there is no such source.
 *  @param amplified  content of the ports whose samples a receiver has amplified */
types::ReturnRules upstreamReturnRules(const InputPortBase& port, const char* amplified);

/** As upstreamValue, for the property `mount`: the pose on its body of the sensor that made the samples. */
std::optional<types::Mount> upstreamMount(const InputPortBase& port);

/** Returns why the samples of a port are no codes, by the properties of the tasks upstream: none codes them, or one has
 *  another output. Empty: they are codes, or nothing is known. */
std::string whyNoCodes(const InputPortBase& port);

/** The output ports of poses that a port's samples depend on, nearest first. */
std::vector<const OutputPortBase*> upstreamPoses(const InputPortBase& port);

}  // namespace insonify::framework
