#pragma once
#include <string>
#include <vector>

#include "types/DeploymentStatus.hpp"

namespace insonify::types {

/** What a task may see of its deployment and do to it, through Environment::deployment. Any thread, but none of a
 *  task's cycles: a call waits for the task that is called. Valid from configure to cleanup. */
class DeploymentControl {
public:
    virtual ~DeploymentControl() = default;

    /** As things are now; waits for no task. */
    virtual DeploymentStatus status() const = 0;
    /** By task, in file order. */
    virtual std::vector<TaskInterface> interfaces() const = 0;
    /** Calls an operation, "camera.setRate", with arguments in YAML; gives the result as text. ConfigError: no
     *  such task or operation, or arguments that do not fit; a refusal is what the operation throws. */
    virtual std::string call(const std::string& operation, const std::vector<std::string>& arguments) = 0;
    /** In lockstep: simulated time stands still once this returns, or goes on. Throws std::runtime_error in realtime.
     */
    virtual void pause(bool on) = 0;
    /** While it stands still: one instant more. Throws std::runtime_error when it does not stand still. */
    virtual void step() = 0;
};

}  // namespace insonify::types
