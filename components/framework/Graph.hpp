#pragma once
#include <memory>
#include <string>
#include <vector>

#include "components/framework/Port.hpp"
#include "components/framework/TaskContext.hpp"

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

}  // namespace insonify::framework
