#pragma once
#include <string>

#include "components/framework/Graph.hpp"
#include "types/DeploymentControl.hpp"

namespace insonify::framework {

// What a deployment tells of itself while it runs; waits for no task.
types::TaskStatus statusOf(const TaskContext& task, const std::string& type);
types::ConnectionStatus statusOf(const Connection& connection);
types::TaskInterface interfaceOf(const TaskContext& task);

}  // namespace insonify::framework
