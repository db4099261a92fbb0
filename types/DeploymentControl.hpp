#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "types/Plan.hpp"
#include "types/TaskRecord.hpp"
#include "types/Time.hpp"

namespace insonify::types {

struct PortStatus {
    std::string name, type;
    uint64_t written = 0;  ///< Samples [1].
};

/** How far a task has come in what it plays. */
struct Playback {
    double at_s = 0;      ///< After the start of it [s].
    double length_s = 0;  ///< [s]
};

struct TaskStatus {
    TaskRecord record;         ///< Name, type, values of properties.
    std::string state, error;  ///< Text of the last error; empty: there was none.
    double cycle_s = 0;        ///< How long the last cycle worked [s].
    double latency_s = 0;      ///< From the stamp of the last sample written to its being written, realtime only [s].
    std::optional<Plan> plan;  ///< As the task told it last.
    std::vector<PortStatus> outputs;
    std::optional<Playback> playback = std::nullopt;  ///< Of a task that plays a log.
};

struct ConnectionStatus {
    std::string from, to;      ///< "task.port"
    std::string policy;        ///< "data", "buffer", "circular_buffer"
    uint64_t lost = 0;         ///< Samples that were dropped before they were read [1].
    uint64_t passed_over = 0;  ///< Samples that the reader has left aside for newer ones [1].
};

/** A deployment at one moment of its run. */
struct DeploymentStatus {
    Time now;  ///< On the deployment's clock.
    bool lockstep = false, paused = false;
    std::vector<TaskStatus> tasks;  ///< In file order.
    std::vector<ConnectionStatus> connections;
};

/** What can be called and set in a task; it does not change while the deployment lives. */
struct TaskInterface {
    std::string name;
    std::vector<PropertyInfo> properties;  ///< Whole ones: blocks are one.
    std::vector<std::string> operations;   ///< "seek": "void(double)" is "seek void(double)".
};

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
