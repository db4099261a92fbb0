#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "types/Time.hpp"
#include "types/samples/Plan.hpp"
#include "types/samples/TaskRecord.hpp"

namespace insonify::types {

struct PortStatus {
    std::string name, type;
    uint64_t written = 0;  ///< Number of samples [1].
};

/** The progress of a task that plays a log. */
struct Playback {
    double at_s = 0;      ///< Time since the start of the log [s].
    double length_s = 0;  ///< [s]
    bool paused = false;  ///< Whether the log's time stands, apart from that of the deployment.
};

/** What a task that records has written, and how much it still can. */
struct Recording {
    std::string file;         ///< The one that is written now.
    uint64_t bytes = 0;       ///< In all files of this run [B].
    uint64_t free_bytes = 0;  ///< On the disk of the file [B].
};

struct TaskStatus {
    TaskRecord record;         ///< Name, type, values of properties.
    std::string state, error;  ///< `error`: text of the last error; empty when there was none.
    double cycle_s = 0;        ///< Duration of the last cycle [s].
    double latency_s = 0;      ///< From the stamp of the last written sample to the write, realtime only [s].
    std::optional<Plan> plan;  ///< The last plan of the task.
    std::vector<PortStatus> outputs;
    std::optional<Playback> playback = std::nullopt;    ///< Only for a task that plays a log.
    std::optional<Recording> recording = std::nullopt;  ///< Only for a task that records.
};

struct ConnectionStatus {
    std::string from, to;      ///< "task.port"
    std::string policy;        ///< "data", "buffer", "circular_buffer"
    uint64_t lost = 0;         ///< Samples that were dropped before they were read [1].
    uint64_t passed_over = 0;  ///< Samples that the reader has skipped for newer samples [1].
};

/** The status of a deployment at one time. */
struct DeploymentStatus {
    Time now;  ///< On the deployment's clock.
    bool lockstep = false, paused = false;
    std::vector<TaskStatus> tasks;  ///< In file order.
    std::vector<ConnectionStatus> connections;
};

/** The properties and operations of a task. They do not change during the life of the deployment. */
struct TaskInterface {
    std::string name;
    std::vector<PropertyInfo> properties;  ///< Top-level properties; a block is one property.
    std::vector<std::string> operations;   ///< Name and signature: "seek void(double)".
    std::vector<std::string> fixed = {};   ///< Names of the properties that cannot be set while the task runs.
};

/** A task's access to its deployment, through Environment::deployment. May be used on any thread, but not in the cycle
 *  of a task, because a call waits for the called task. Valid from configure to cleanup. */
class DeploymentControl {
public:
    virtual ~DeploymentControl() = default;

    /** Returns the current status; waits for no task. */
    virtual DeploymentStatus status() const = 0;
    /** Returns an entry per task, in file order. */
    virtual std::vector<TaskInterface> interfaces() const = 0;
    /** Calls an operation such as "camera.setRate" with arguments in YAML, and returns the result as text. Throws
     *  ConfigError for an unknown task or operation, or for wrong arguments; passes on exceptions of the operation. */
    virtual std::string call(const std::string& operation, const std::vector<std::string>& arguments) = 0;
    /** Pauses or resumes simulated time in lockstep; a pause is in effect on return. Throws std::runtime_error in
     *  realtime. */
    virtual void pause(bool on) = 0;
    /** Advances a paused deployment by one instant. Throws std::runtime_error when it is not paused. */
    virtual void step() = 0;
};

}  // namespace insonify::types
