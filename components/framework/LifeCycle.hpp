#pragma once
#include <memory>
#include <vector>

#include "components/framework/TaskContext.hpp"

namespace insonify::framework {

/** The transitions of a task as operations: configure, start, stop, cleanup, recover. A call that is refused throws
 *  std::runtime_error with the reason. */
std::vector<std::unique_ptr<OperationBase>> lifeCycleOperations(TaskContext& task);

}  // namespace insonify::framework
