#include "components/framework/Graph.hpp"

#include <algorithm>
#include <set>

namespace insonify::framework {
namespace {

bool isBuffered(const Connection& connection) { return connection.policy.type != ConnPolicy::Data; }

/** Returns the first waiting task whose writers are all placed; null when there is none. */
TaskContext* nextTask(const std::vector<TaskContext*>& waiting, const std::vector<Connection>& connections,
                      bool heed_buffered) {
    const auto waits = [&](const TaskContext* task) {
        return std::find(waiting.begin(), waiting.end(), task) != waiting.end();
    };
    for (TaskContext* task : waiting) {
        const auto holdsBack = [&](const Connection& c) {
            return &c.to->owner() == task && &c.from->owner() != task && waits(&c.from->owner()) &&
                   (heed_buffered || !isBuffered(c));
        };
        if (std::none_of(connections.begin(), connections.end(), holdsBack)) return task;
    }
    return nullptr;
}

bool leadsTo(const TaskContext& from, const TaskContext& to, const std::vector<Connection>& connections,
             std::set<const TaskContext*>& seen) {
    if (&from == &to) return true;
    if (!seen.insert(&from).second) return false;
    return std::any_of(connections.begin(), connections.end(), [&](const Connection& c) {
        return !isBuffered(c) && &c.from->owner() == &from && leadsTo(c.to->owner(), to, connections, seen);
    });
}

}  // namespace

bool hasFailed(const TaskContext& task) {
    return task.state() == TaskState::Exception || task.state() == TaskState::FatalError;
}

TaskContext* Graph::task(const std::string& name) const {
    for (const auto& task : tasks_)
        if (task->name() == name) return task.get();
    return nullptr;
}

std::vector<const Connection*> Graph::unbufferedLoops() const {
    std::vector<const Connection*> loops;
    std::set<const TaskContext*> reported;
    for (const Connection& connection : connections_) {
        std::set<const TaskContext*> seen;
        if (isBuffered(connection) || !leadsTo(connection.to->owner(), connection.from->owner(), connections_, seen))
            continue;
        if (reported.insert(&connection.to->owner()).second) loops.push_back(&connection);
    }
    return loops;
}

TaskContext& Graph::add(std::unique_ptr<TaskContext> task) { return *tasks_.emplace_back(std::move(task)); }

bool Graph::connect(OutputPortBase& from, InputPortBase& to, ConnPolicy policy) {
    if (!from.connectTo(to, policy)) return false;
    connections_.push_back({&from, &to, policy, to.channels().back()});
    return true;
}

void Graph::arrange() {
    std::vector<TaskContext*> waiting;
    for (const auto& task : tasks_) waiting.push_back(task.get());
    order_.clear();
    while (!waiting.empty()) {
        TaskContext* next = nextTask(waiting, connections_, true);
        if (!next) next = nextTask(waiting, connections_, false);
        if (!next) next = waiting.front();
        order_.push_back(next);
        waiting.erase(std::find(waiting.begin(), waiting.end(), next));
    }
    counted_ = countedOutputs();
}

std::vector<const OutputPortBase*> Graph::countedOutputs() const {
    const auto isCounted = [](const PortBase* port) { return port->counted(); };
    std::vector<const OutputPortBase*> counted;
    for (const auto& task : tasks_)
        if (std::ranges::none_of(task->inputs(), isCounted))
            std::ranges::copy_if(task->outputs(), std::back_inserter(counted), isCounted);
    return counted;
}

uint64_t Graph::countedSamples() const {
    if (counted_.empty()) return 0;
    return (*std::ranges::min_element(counted_, {}, &OutputPortBase::written))->written();
}

bool Graph::hasFailed() const {
    return std::ranges::any_of(tasks_, [](const auto& task) { return framework::hasFailed(*task); });
}

bool Graph::hasSourceInError() const {
    return std::ranges::any_of(
        counted_, [](const OutputPortBase* port) { return port->owner().state() == TaskState::RunTimeError; });
}

}  // namespace insonify::framework
