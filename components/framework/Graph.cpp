#include "components/framework/Graph.hpp"

#include <algorithm>
#include <set>

namespace insonify::framework {
namespace {

bool isBuffered(const Connection& connection) { return connection.policy.type != ConnPolicy::Data; }

/** The first task of which every writer is placed already; null when there is none. */
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

std::vector<TaskContext*> writersFirst(const std::vector<std::unique_ptr<TaskContext>>& tasks,
                                       const std::vector<Connection>& connections) {
    std::vector<TaskContext*> waiting, order;
    for (const auto& task : tasks) waiting.push_back(task.get());
    while (!waiting.empty()) {
        TaskContext* next = nextTask(waiting, connections, true);
        if (!next) next = nextTask(waiting, connections, false);
        if (!next) next = waiting.front();
        order.push_back(next);
        waiting.erase(std::find(waiting.begin(), waiting.end(), next));
    }
    return order;
}

std::vector<const Connection*> unbufferedLoops(const std::vector<Connection>& connections) {
    std::vector<const Connection*> loops;
    std::set<const TaskContext*> reported;
    for (const Connection& connection : connections) {
        std::set<const TaskContext*> seen;
        if (isBuffered(connection) || !leadsTo(connection.to->owner(), connection.from->owner(), connections, seen))
            continue;
        if (reported.insert(&connection.to->owner()).second) loops.push_back(&connection);
    }
    return loops;
}

}  // namespace insonify::framework
