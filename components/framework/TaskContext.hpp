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

#include "components/framework/execution/Timing.hpp"
#include "types/Thread.hpp"
#include "types/Time.hpp"
#include "types/samples/DeploymentControl.hpp"
#include "types/samples/Plan.hpp"
#include "types/samples/TaskRecord.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/RosNames.hpp"

namespace insonify::framework {

/** The states of Orocos, with Orocos' numbers. */
enum class TaskState : int32_t { Init, PreOperational, FatalError, Exception, Stopped, Running, RunTimeError };
const char* toString(TaskState state);

/** Whether a transition was made, and the reason if not. */
struct Outcome {
    bool done = true;
    std::string reason;  ///< Empty when done.
    explicit operator bool() const { return done; }
};

types::Time wallClock();
/** A clock that is never set, since an unspecified time. */
types::Time steadyClock();

/** Folders, clock and other surroundings of a task, shared by all tasks of a deployment. */
struct Environment {
    std::filesystem::path input_folder = ".";      ///< Folder of the deployment file.
    std::filesystem::path output_folder = ".";     ///< `--out`.
    std::function<types::Time()> now = wallClock;  ///< Or simulated or log time, by the deployment's schedule.
    std::function<types::Time()> start_time;       ///< Start of the run, on the same clock.
    std::function<types::Time()> run_time;         ///< See elapsed(); empty: by `now`.
    bool lockstep = false;
    bool wall_clock = true;  ///< In realtime: no task has replaced the clock by its own.
    bool is_shard = false;   ///< Only some samples of the run are made, see RunLimits::shard.
    /** This instant is before the shard: see framework::Divisible. */
    bool rehearsing = false;
    bool is_refused = false;      ///< The deployment has errors, so that no task needs to wait for another program.
    std::string deployment_text;  ///< The YAML as read, for the log's metadata.
    uint64_t seed = 0;            ///< Seed of the run (`--seed`), 0 when not given.
    types::RosNames names;        ///< Namespace and frame prefix of the deployment.
    std::function<void(const std::string&)> warn;  ///< Warns the user at once; empty outside of a deployment.
    /** Returns the last published record of each task, in file order, without waiting for any task. Empty for a task
     *  outside of a deployment. */
    std::function<std::vector<types::TaskRecord>()> records;
    /** The number of times that tasks have published their records. Unchanged: records() returns the same as before. */
    std::shared_ptr<std::atomic<uint64_t>> record_changes = std::make_shared<std::atomic<uint64_t>>(0);
    types::DeploymentControl* deployment = nullptr;  ///< Null for a task outside of a deployment.

    /** Returns the time since the start of the run. In a run by the wall clock it continues evenly when that clock is
     *  set. */
    types::Time elapsed() const { return run_time ? run_time() : now() - start_time(); }
    /** Returns whether a task that cannot write its file drops and counts samples instead of ending the run. This is so
     *  in realtime by the wall clock, where the other tasks cannot wait. Valid from startHook on. */
    bool mayLose() const { return deployment && !lockstep && wall_clock; }
};

class Activity;
class Event;
class InputPortBase;
class OutputPortBase;
template <class T>
class OutputPort;
class PropertiesBase;
class OperationBase;

/** An error of a port that is made which TaskContext::check() reports as well: a log that cannot be read. */
struct ReportedByCheck : types::ConfigError {
    using ConfigError::ConfigError;
};

/** A component: ports, properties and operations as members, and the hooks of the Orocos life cycle.
 *
 *      PreOperational -configure-> Stopped -start-> Running -stop-> Stopped -cleanup-> PreOperational
 *
 *  All hooks run on the task's own thread, for any caller. cleanupHook undoes configureHook and stopHook undoes
 *  startHook, each exactly once. A hook that returns false or throws has not done its work and is not undone. If a hook
 *  throws, finished hooks are undone, exceptionHook runs, and the task ends in Exception with the message (FatalError
 *  when the undoing throws as well). A `types::ConfigError` from configureHook is kept whole in `configError()`.
 *  Differences from Orocos: a second configure() cleans up first; a throw in stopHook or cleanupHook can be recovered
 *  from; start() runs no updateHook; a transition requested within another is refused. */
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

    // Transitions; each returns once its hooks have run on the task's thread. Refused if that cannot be started.
    Outcome configure();
    Outcome start();  ///< Clears the input ports, then startHook.
    Outcome stop();
    Outcome cleanup();
    Outcome recover();  ///< RunTimeError -> Running; Exception -> PreOperational.
    /** Runs one cycle: updateHook (errorHook in RunTimeError), repeated until no triggering port holds a new sample. */
    void update();
    bool triggered() const;  ///< Whether a triggering port holds a new sample.

    /** Text of the last exception, error() or refusal; empty if there was none. */
    std::string lastError() const;
    /** The types::ConfigError that configureHook threw, or null. */
    const types::ConfigError* configError() const { return config_error_.get(); }

    // Accessors for `describe`, the deployment and tests, in the order of declaration.
    const std::vector<InputPortBase*>& inputs() const { return inputs_; }
    const std::vector<OutputPortBase*>& outputs() const { return outputs_; }
    const std::vector<PropertiesBase*>& properties() const { return properties_; }
    const std::vector<OperationBase*>& operations() const { return operations_; }
    const std::vector<Event*>& events() const { return events_; }
    InputPortBase* input(const std::string& port);  ///< Null when there is none of that name.
    OutputPortBase* output(const std::string& port);
    /** The operations configure, start, stop, cleanup, recover; `set<Property>` for each property (setRange); the
     *  task's own. */
    OperationBase* operation(const std::string& name);

    /** Makes a port that exists only because a connection names it, see DynamicPorts.hpp; null refuses. Throws
     *  ReportedByCheck for an error that check() reports as well. */
    virtual InputPortBase* makeInput(const std::string& /*port*/, OutputPortBase& /*source*/) { return nullptr; }
    virtual OutputPortBase* makeOutput(const std::string& /*port*/) { return nullptr; }

    /** Reports errors that are visible without configuring (missing files...); paths as in types::Diagnostic. */
    virtual void check(types::Diagnostics& /*diagnostics*/) const {}
    /** Returns notices for the user (a mesh without triangles, dropped vertices). Valid after configure. */
    virtual types::Notices notices() const { return {}; }
    /** True once a source has no more samples: a lockstep run ends when all sources have finished. */
    virtual bool finished() const { return false; }
    /** Whether the task communicates outside its deployment, over a network or with a device. */
    virtual bool reachesOutside() const { return false; }

    /** In realtime, a triggered task also runs a cycle after this time without one [s]; 0: it waits for samples. Called
     *  once, when the task has started. */
    virtual double wakeAfter() const { return 0; }

    /** Properties, and the plan of a Planned task, for any thread; the deployment adds the type. */
    types::TaskRecord record() const {
        std::lock_guard lock(record_mutex_);
        return record_;
    }
    /** The plan of record(). */
    std::optional<types::Plan> recordedPlan() const {
        std::lock_guard lock(record_mutex_);
        return recorded_plan_;
    }
    /** Copies the current properties and plan into record(). Called on the task's thread, or before the thread exists.
     *  configure() and property setters call it. */
    void refreshRecord();

    Environment& environment() { return *environment_; }
    const Environment& environment() const { return *environment_; }
    void setEnvironment(std::shared_ptr<Environment> environment) { environment_ = std::move(environment); }
    Activity& activity() { return *activity_; }
    const Activity& activity() const { return *activity_; }
    const Statistics& cycles() const { return cycles_; }  ///< Durations of updateHook without pauses [s].
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
    /** Lets the task apply changed properties, on its thread. */
    Outcome applyProperties(const std::string& what);
    // For its activity only.
    /** Runs updateHook or errorHook once; true when a triggering port still holds a sample and this pass took one. */
    bool cycle();

protected:
    virtual bool configureHook() { return true; }
    virtual bool startHook() { return true; }
    virtual void updateHook() {}
    virtual void errorHook() {}
    virtual void stopHook() {}
    virtual void cleanupHook() {}
    virtual void exceptionHook() {}
    /** Applies the new values after a property was set on a configured task. If it returns false or throws, the old
     *  values are restored. The default refuses while running; the task then needs another configure(). */
    virtual bool propertiesHook() { return !isRunning(); }

    /** Running -> RunTimeError: a recoverable error; from here on errorHook runs instead of updateHook. The default
     *  errorHook does nothing; a task that recovers by itself calls recover() in it. Only while running: in a hook of
     *  another transition the text is kept for its refusal, or thrown where the hook cannot refuse. */
    void error(const std::string& why);
    /** Warns the user now, "name: text", and in the run's summary; any thread. Repeat a warning rarely. */
    void warn(const std::string& text);
    /** Records the time of one named stage of this cycle [s]. Names must be string literals used in the first cycle. */
    void recordStage(const char* name, double seconds);

    types::Time now() const { return environment_->now(); }
    std::filesystem::path inputPath(const std::string& file) const;   ///< Relative to the deployment file.
    std::filesystem::path outputPath(const std::string& file) const;  ///< Relative to `--out`; makes no folders.

private:
    using Hook = void (TaskContext::*)();

    Outcome transition(const char* verb, auto&& work);
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
    mutable types::PriorityMutex error_mutex_;
    std::string last_error_;
    mutable types::PriorityMutex record_mutex_;
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

/** Wakes a task from outside its deployment: for a message, a device.
 *
 *      framework::Event arrived_{this};  // and where it arrives, on any thread: arrived_.raise();
 *
 *  In realtime the task then runs a cycle, unless it has a period. The task needs no other activity. */
class Event {
public:
    explicit Event(TaskContext* owner) : owner_(*owner) { owner->enlist(this); }
    Event(const Event&) = delete;
    Event& operator=(const Event&) = delete;
    void raise();

private:
    TaskContext& owner_;
};

}  // namespace insonify::framework
