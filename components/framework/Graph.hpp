#pragma once
#include <memory>
#include <string>
#include <vector>

#include "components/framework/Port.hpp"
#include "components/framework/TaskContext.hpp"

namespace insonify::framework {

/** One connection as made. */
struct Connection {
    OutputPortBase* from;
    InputPortBase* to;
    ConnPolicy policy;
    std::shared_ptr<const ChannelBase> channel;
    std::string text() const { return from->path() + ">" + to->path(); }
};

/** Tasks, the connections between their ports, and the order in which they work. */
class Graph {
public:
    const std::vector<std::unique_ptr<TaskContext>>& tasks() const { return tasks_; }  ///< In the order of add().
    TaskContext* task(const std::string& name) const;                                  ///< Null when there is none.
    const std::vector<Connection>& connections() const { return connections_; }
    /** Writers before readers, else as in tasks(); where a loop forbids that, a buffered connection goes backwards. */
    const std::vector<TaskContext*>& order() const { return order_; }
    /** Connections without a buffer that lie on a loop made of such, one for each task that is on one. */
    std::vector<const Connection*> unbufferedLoops() const;

    TaskContext& add(std::unique_ptr<TaskContext> task);
    /** False when the types of the ports differ. */
    bool connect(OutputPortBase& from, InputPortBase& to, ConnPolicy policy);
    /** Finds the order, once all is connected. */
    void arrange();

    /** Counted samples (PortBase::counted) that every source of such has written; a source of them reads none. */
    uint64_t countedSamples() const;
    /** Whether a task failed, so that a run must end: Exception or FatalError. */
    bool hasFailed() const;
    /** Whether a source of counted samples is in error: it gives none to count. */
    bool hasSourceInError() const;

private:
    std::vector<const OutputPortBase*> countedOutputs() const;

    std::vector<std::unique_ptr<TaskContext>> tasks_;
    std::vector<Connection> connections_;
    std::vector<TaskContext*> order_;
    std::vector<const OutputPortBase*> counted_;
};

/** Exception or FatalError. */
bool hasFailed(const TaskContext& task);

}  // namespace insonify::framework
