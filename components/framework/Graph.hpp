#pragma once
#include <vector>

#include "components/framework/Deployment.hpp"

namespace insonify::framework {

/** Writers before readers, else in file order; where a loop forbids that, a buffered connection goes backwards. */
std::vector<TaskContext*> writersFirst(const std::vector<std::unique_ptr<TaskContext>>& tasks,
                                       const std::vector<Connection>& connections);

/** Connections without a buffer that lie on a loop made of such, one for each task that is on one. */
std::vector<const Connection*> unbufferedLoops(const std::vector<Connection>& connections);

}  // namespace insonify::framework
