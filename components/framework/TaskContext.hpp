#pragma once
#include <atomic>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/Timing.hpp"
#include "types/ConfigError.hpp"
#include "types/DeploymentControl.hpp"
#include "types/Plan.hpp"
#include "types/RosNames.hpp"
#include "types/TaskRecord.hpp"
#include "types/Time.hpp"

namespace insonify::framework {

/** The states of Orocos, with its numbers. */
enum class TaskState : int32_t { Init, PreOperational, FatalError, Exception, Stopped, Running, RunTimeError };
const char* toString(TaskState state);

/** Whether a transition was made, and if not, why. */
struct Outcome {
    bool done = true;
    std::string reason;  ///< Empty when done.
    explicit operator bool() const { return done; }
};

types::Time wallClock();

/** Where a task finds and leaves files, and what time it is. Shared by all tasks of a deployment. */
struct Environment {
    std::filesystem::path input_folder = ".";      ///< Of the deployment file.
    std::filesystem::path output_folder = ".";     ///< `--out`.
    std::function<types::Time()> now = wallClock;  ///< Simulated or log time instead, where the deployment says so.
    std::function<types::Time()> start_time;       ///< Of the run, on the same clock.
    bool lockstep = false;
    bool wall_clock = true;  ///< In realtime: no task has put a clock of its own in its place.
    bool is_shard = false;   ///< Only some samples of the run are made, see RunLimits::shard.
    /** This instant is not of the shard: see framework::Divisible. */
    bool rehearsing = false;
    std::string deployment_text;                   ///< The YAML as read, for the log's metadata.
    uint64_t seed = 0;                             ///< Of the run (`--seed`), 0 when not given.
    types::RosNames names;                         ///< Namespace and frame prefix of the deployment.
    std::function<void(const std::string&)> warn;  ///< Tells the user at once; empty outside of a deployment.
    /** The records of all tasks, in file order, as each has told its own last: waits for no task. Empty for a task
     *  outside of a deployment. */
    std::function<std::vector<types::TaskRecord>()> records;
    /** How often tasks have told their records anew: so that nobody asks for them in vain. */
    std::shared_ptr<std::atomic<uint64_t>> record_changes = std::make_shared<std::atomic<uint64_t>>(0);
    types::DeploymentControl* deployment = nullptr;  ///< Null for a task outside of a deployment.
};

class Activity;
class Event;
class InputPortBase;
class OutputPortBase;
template <class T>
class OutputPort;
class PropertiesBase;
class OperationBase;

/** A component: ports, properties and operations as members, and the hooks of the Orocos life cycle.
 *
 *      PreOperational -configure-> Stopped -start-> Running -stop-> Stopped -cleanup-> PreOperational
 *
 *  All hooks run on the task's own thread, whoever asks. configureHook is undone by cleanupHook, startHook by
 *  stopHook, each exactly once; a hook that returns false or throws has not done its work and is not undone. A hook
 *  that throws is caught, what had been done is undone, exceptionHook runs, and the task ends in Exception with the
 *  message (FatalError when the undoing throws as well). `types::ConfigError` from configureHook is kept whole in
 *  `configError()`. Where Orocos differs: a second configure() cleans up first; a throw in stopHook or cleanupHook
 *  can be recovered from; start() runs no updateHook of its own; a transition asked for within another is refused. */
class TaskContext {
public:
    using Stages = std::map<std::string, Statistics, std::less<>>;

    explicit TaskContext(std::string name);
    virtual ~TaskContext();
    TaskContext(const TaskContext&) = delete;
    TaskContext& operator=(const TaskContext&) = delete;

    const std::string& name() const { return name_; }
    TaskState state() const { return state_.load(); }
    bool isRunning() const { return state() == TaskState::Running || state() == TaskState::RunTimeError; }

    // Transitions; each returns once its hooks have run on the task's thread.
    Outcome configure();
    Outcome start();  ///< Clears the input ports, then startHook.
    Outcome stop();
    Outcome cleanup();
    Outcome recover();  ///< RunTimeError -> Running; Exception -> PreOperational.
    /** One cycle: updateHook (errorHook in RunTimeError), again until no triggering port holds a new sample. */
    void update();
    bool triggered() const;  ///< Whether a triggering port holds a new sample.

    /** Text of the last throw, error() or refusal; empty if there was none. */
    std::string lastError() const;
    /** The diagnostic that configureHook threw, if it was one of the configuration. */
    const types::ConfigError* configError() const { return config_error_.get(); }

    // What `describe`, the deployment and tests look at. Order is that of declaration.
    const std::vector<InputPortBase*>& inputs() const { return inputs_; }
    const std::vector<OutputPortBase*>& outputs() const { return outputs_; }
    const std::vector<PropertiesBase*>& properties() const { return properties_; }
    const std::vector<OperationBase*>& operations() const { return operations_; }
    const std::vector<Event*>& events() const { return events_; }
    InputPortBase* input(const std::string& port);  ///< Null when there is none of that name.
    OutputPortBase* output(const std::string& port);
    /** configure, start, stop, cleanup, recover; `set<Property>` for each property (setRange); those of the task. */
    OperationBase* operation(const std::string& name);

    /** A port that exists only because a connection names it, as DynamicPorts.hpp makes them: null refuses. */
    virtual InputPortBase* makeInput(const std::string& /*port*/, OutputPortBase& /*source*/) { return nullptr; }
    virtual OutputPortBase* makeOutput(const std::string& /*port*/) { return nullptr; }

    /** Diagnostics that can be seen without configuring (files that are not there...); paths as in types::Diagnostic.
     */
    virtual void check(types::Diagnostics& /*diagnostics*/) const {}
    /** Notices for the user (a mesh without triangles, dropped vertices). Valid after configure. */
    virtual std::vector<std::string> notices() const { return {}; }
    /** True once a source has nothing more to say: a lockstep run ends when all sources have. */
    virtual bool finished() const { return false; }
    /** Whether it talks to others than its deployment, over a network or to a device. */
    virtual bool reachesOutside() const { return false; }

    /** In realtime a triggered task runs a cycle also when it has run none for so long [s]; 0: it waits for samples.
     *  Asked for once, when it has started. */
    virtual double wakeAfter() const { return 0; }

    /** Properties, and the plan of a task that is Planned, for any thread; the type is the deployment's to know. */
    types::TaskRecord record() const {
        std::lock_guard lock(record_mutex_);
        return record_;
    }
    /** The plan of record(). */
    std::optional<types::Plan> recordedPlan() const {
        std::lock_guard lock(record_mutex_);
        return recorded_plan_;
    }
    /** Takes what holds now over into record(): on the task's thread, or before there is one. configure() and what
     *  sets properties do it. */
    void refreshRecord();

    Environment& environment() { return *environment_; }
    const Environment& environment() const { return *environment_; }
    void setEnvironment(std::shared_ptr<Environment> environment) { environment_ = std::move(environment); }
    Activity& activity() { return *activity_; }
    const Activity& activity() const { return *activity_; }
    const Statistics& cycles() const { return cycles_; }  ///< Times of updateHook, pauses left out [s].
    const Stages& stages() const { return stages_; }      ///< Read when stopped.
    Timing& timing() { return timing_; }
    const Timing& timing() const { return timing_; }

    // For ports, properties and operations only, which enlist themselves.
    void enlist(InputPortBase* port) { inputs_.push_back(port); }
    void enlist(OutputPortBase* port) { outputs_.push_back(port); }
    void enlist(PropertiesBase* properties) { properties_.push_back(properties); }
    void enlist(OperationBase* operation) { operations_.push_back(operation); }
    void enlist(Event* event) { events_.push_back(event); }
    void noteTaken() { ++taken_; }
    /** Lets the task take changed properties over, on its thread. */
    Outcome applyProperties(const std::string& what);
    // For its activity only.
    /** One pass of updateHook or errorHook; true when a triggering port still holds a sample and this pass took one. */
    bool cycle();

protected:
    virtual bool configureHook() { return true; }
    virtual bool startHook() { return true; }
    virtual void updateHook() {}
    virtual void errorHook() {}
    virtual void stopHook() {}
    virtual void cleanupHook() {}
    virtual void exceptionHook() {}
    /** A property was set while the task is configured: takes the new values over. False or a throw refuses them, and
     *  the old ones are back. Tasks that do not override this refuse while running, and need to configure() again. */
    virtual bool propertiesHook() { return !isRunning(); }

    /** Running -> RunTimeError: a recoverable error; from here errorHook runs instead of updateHook.
     *  The default errorHook does nothing; a task that heals itself calls recover() from it. Only while running: a hook
     *  of another transition keeps the text for its refusal, and throws where it cannot refuse. */
    void error(const std::string& why);
    /** Tells the user now, "name: text", and in the run's summary; from any thread. For what recurs, seldom. */
    void warn(const std::string& text);
    /** Time of one named stage of this cycle [s]; names must be string literals met in the first cycle. */
    void recordStage(const char* name, double seconds);

    types::Time now() const { return environment_->now(); }
    std::filesystem::path inputPath(const std::string& file) const;   ///< Relative to the deployment file.
    std::filesystem::path outputPath(const std::string& file) const;  ///< Relative to `--out`; makes no folders.

private:
    using Hook = void (TaskContext::*)();

    template <class Transition>
    Outcome transition(const char* verb, Transition&& work);
    Outcome configureNow();
    Outcome startNow();
    Outcome stopNow();
    Outcome cleanupNow();
    Outcome recoverNow();
    Outcome refuse(const std::string& why);
    Outcome notAllowed(const char* allowed);
    Outcome notDone(const char* hook);
    Outcome fail(const char* hook, std::exception_ptr thrown, bool undo_start, bool undo_configure);
    void failCycle(const char* hook, std::exception_ptr thrown);
    bool attempt(Hook hook);
    void setState(TaskState state);
    void setLastError(const std::string& text);

    std::string name_;
    std::atomic<TaskState> state_{TaskState::PreOperational};
    std::shared_ptr<Environment> environment_;
    std::unique_ptr<Activity> activity_;
    std::unique_ptr<types::ConfigError> config_error_;
    mutable std::mutex error_mutex_;
    std::string last_error_;
    mutable std::mutex record_mutex_;
    types::TaskRecord record_;
    std::optional<types::Plan> recorded_plan_;
    std::vector<InputPortBase*> inputs_;
    std::vector<OutputPortBase*> outputs_;
    std::vector<PropertiesBase*> properties_;
    std::vector<OperationBase*> operations_;
    std::vector<Event*> events_;
    std::unique_ptr<OutputPort<int32_t>> state_port_;
    std::vector<std::unique_ptr<OperationBase>> life_cycle_;
    const char* transition_ = nullptr;  // the one under way
    uint64_t taken_ = 0;                // samples read by the task
    Statistics cycles_;
    Timing timing_;
    Stages stages_;
};

}  // namespace insonify::framework
