#include "components/framework/TaskContext.hpp"

#include <algorithm>
#include <chrono>

#include "components/framework/Offers.hpp"
#include "components/framework/Operation.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/execution/Activity.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::framework {
namespace {

std::string toText(std::exception_ptr thrown) {
    try {
        std::rethrow_exception(thrown);
    } catch (const std::exception& error) {
        return types::getReason(error);
    } catch (...) {
        return "an exception that is not a std::exception";
    }
}

template <class Ports>
auto find(const Ports& ports, const std::string& name) -> typename Ports::value_type {
    for (auto* port : ports)
        if (port->name() == name) return port;
    return nullptr;
}

/** The transitions of a task as operations: configure, start, stop, cleanup, recover. A refused call throws
 *  std::runtime_error with the reason. */
std::vector<std::unique_ptr<OperationBase>> lifeCycleOperations(TaskContext& task) {
    struct Transition {
        const char *name, *doc;
        Outcome (TaskContext::*make)();
    };
    static constexpr Transition transitions[] = {
        {"configure", "PreOperational or Stopped -> Stopped", &TaskContext::configure},
        {"start", "Stopped -> Running", &TaskContext::start},
        {"stop", "Running or RunTimeError -> Stopped", &TaskContext::stop},
        {"cleanup", "Stopped -> PreOperational", &TaskContext::cleanup},
        {"recover", "RunTimeError -> Running; Exception -> PreOperational", &TaskContext::recover}};
    std::vector<std::unique_ptr<OperationBase>> operations;
    for (const Transition& transition : transitions)
        operations.push_back(std::make_unique<Operation<void()>>(
            &task, transition.name, transition.doc, [&task, make = transition.make] {
                if (const Outcome outcome = (task.*make)(); !outcome) throw std::runtime_error(outcome.reason);
            }));
    return operations;
}

}  // namespace

types::Time wallClock() {
    const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
    return {std::chrono::duration_cast<std::chrono::microseconds>(since_epoch).count()};
}

types::Time steadyClock() {
    const auto since = std::chrono::steady_clock::now().time_since_epoch();
    return {std::chrono::duration_cast<std::chrono::microseconds>(since).count()};
}

const char* toString(TaskState state) {
    static constexpr const char* names[] = {"Init",    "PreOperational", "FatalError",  "Exception",
                                            "Stopped", "Running",        "RunTimeError"};
    return names[static_cast<size_t>(state)];
}

TaskContext::TaskContext(std::string name)
    : name_(std::move(name)),
      environment_(std::make_shared<Environment>()),
      activity_(std::make_unique<Activity>(*this)) {
    environment_->start_time = [start = wallClock()] { return start; };
    state_port_ = std::make_unique<OutputPort<int32_t>>(this, "state", "state of the task, numbered as in Orocos");
    state_port_->keepLast();
    setState(TaskState::PreOperational);
    life_cycle_ = lifeCycleOperations(*this);
}
TaskContext::~TaskContext() = default;

InputPortBase* TaskContext::input(const std::string& port) { return find(inputs_, port); }
OutputPortBase* TaskContext::output(const std::string& port) { return find(outputs_, port); }
OperationBase* TaskContext::operation(const std::string& name) { return find(operations_, name); }

std::string TaskContext::lastError() const {
    std::lock_guard lock(error_mutex_);
    return last_error_;
}
void TaskContext::setLastError(const std::string& text) {
    std::lock_guard lock(error_mutex_);
    last_error_ = text;
}

void TaskContext::refreshRecord() {
    types::TaskRecord record{name_, "", {}, ""};
    for (const PropertiesBase* properties : properties_) record.properties.merge(properties->values());
    const types::Plan* const made = makePlan(*this);
    if (made) record.plan = flowYaml(*made);
    {
        std::lock_guard lock(record_mutex_);
        recorded_plan_ = made ? std::optional(*made) : std::nullopt;
        record_ = std::move(record);
    }
    ++*environment_->record_changes;
}

void TaskContext::setState(TaskState state) {
    state_ = state;
    state_port_->write(static_cast<int32_t>(state));
}

std::filesystem::path TaskContext::inputPath(const std::string& file) const {
    return environment_->input_folder / file;
}
std::filesystem::path TaskContext::outputPath(const std::string& file) const {
    return environment_->output_folder / file;
}

void TaskContext::warn(const std::string& text) {
    if (environment_->warn) environment_->warn(name_ + ": " + text);
}
void TaskContext::recordStage(const char* name, double seconds) {
    auto stage = stages_.find(std::string_view(name));
    if (stage == stages_.end()) stage = stages_.emplace(name, Statistics{}).first;
    stage->second.add(seconds);
}

void TaskContext::error(const std::string& why) {
    setLastError(why);
    if (state() != TaskState::Running) return;
    ++timing_.errors;
    setState(TaskState::RunTimeError);
}

// -- transitions ------------------------------------------------------------------------------------------------------

Outcome TaskContext::transition(const char* verb, auto&& work) {
    Outcome outcome;
    const auto cannot = [&](const std::string& why) { return refuse(std::string("cannot ") + verb + ": " + why); };
    try {
        activity_->call([&] {
            if (transition_) {
                outcome = cannot(name_ + " is in the middle of " + transition_);
                return;
            }
            transition_ = verb;
            outcome = work();
            transition_ = nullptr;
        });
    } catch (const std::exception& failure) {  // there is no thread
        return cannot(failure.what());
    }
    return outcome;
}

Outcome TaskContext::configure() {
    return transition("configure", [this] { return configureNow(); });
}
Outcome TaskContext::start() {
    return transition("start", [this] { return startNow(); });
}
Outcome TaskContext::stop() {
    return transition("stop", [this] { return stopNow(); });
}
Outcome TaskContext::cleanup() {
    return transition("cleanup", [this] { return cleanupNow(); });
}
Outcome TaskContext::recover() {
    return transition("recover", [this] { return recoverNow(); });
}

Outcome TaskContext::refuse(const std::string& why) {
    setLastError(why);
    return {false, why};
}

Outcome TaskContext::notAllowed(const char* allowed) {
    return refuse(std::string("cannot ") + transition_ + ": " + name_ + " is " + toString(state()) + ", must be " +
                  allowed);
}

Outcome TaskContext::notDone(const char* hook) {
    const std::string why = lastError();
    return refuse(std::string(hook) + " refused" + (why.empty() ? "" : ": " + why));
}

Outcome TaskContext::configureNow() {
    if (state() != TaskState::PreOperational && state() != TaskState::Stopped)
        return notAllowed("PreOperational or Stopped");
    if (state() == TaskState::Stopped)
        if (Outcome cleaned = cleanupNow(); !cleaned) return cleaned;
    config_error_.reset();
    setLastError("");
    try {
        if (!configureHook()) return notDone("configureHook");
    } catch (const types::ConfigError& error) {
        config_error_ = std::make_unique<types::ConfigError>(error);
        return fail("configureHook", std::current_exception(), false, false);
    } catch (...) {
        return fail("configureHook", std::current_exception(), false, false);
    }
    refreshRecord();
    setState(TaskState::Stopped);
    return {};
}

Outcome TaskContext::startNow() {
    if (state() != TaskState::Stopped) return notAllowed("Stopped");
    for (InputPortBase* port : inputs_) port->clear();
    setLastError("");
    try {
        if (!startHook()) return notDone("startHook");
    } catch (...) {
        return fail("startHook", std::current_exception(), false, true);
    }
    setState(TaskState::Running);
    return {};
}

Outcome TaskContext::stopNow() {
    if (!isRunning()) return notAllowed("Running or RunTimeError");
    try {
        stopHook();
    } catch (...) {
        return fail("stopHook", std::current_exception(), false, true);
    }
    setState(TaskState::Stopped);
    return {};
}

Outcome TaskContext::cleanupNow() {
    if (state() != TaskState::Stopped) return notAllowed("Stopped");
    try {
        cleanupHook();
    } catch (...) {
        return fail("cleanupHook", std::current_exception(), false, false);
    }
    setState(TaskState::PreOperational);
    return {};
}

Outcome TaskContext::recoverNow() {
    if (state() == TaskState::RunTimeError)
        setState(TaskState::Running);
    else if (state() == TaskState::Exception)
        setState(TaskState::PreOperational);
    else
        return notAllowed("RunTimeError or Exception");
    return {};
}

Outcome TaskContext::applyProperties(const std::string& what) {
    const std::string refused = "cannot set " + what + ": ";
    if (transition_) return refuse(refused + name_ + " is in the middle of " + transition_);
    if (state() < TaskState::Stopped) return {};  // the next configure applies them
    try {
        if (propertiesHook()) return {};
    } catch (...) {
        return refuse(refused + toText(std::current_exception()));
    }
    return refuse(refused + name_ + " is " + toString(state()) + "; it can when it is stopped");
}

bool TaskContext::attempt(Hook hook) {
    try {
        (this->*hook)();
        return true;
    } catch (...) {
        setLastError(lastError() + "; then " + toText(std::current_exception()));
        return false;
    }
}

Outcome TaskContext::fail(const char* hook, std::exception_ptr thrown, bool undo_start, bool undo_configure) {
    setLastError(std::string(hook) + ": " + toText(thrown));
    bool undone = true;
    if (undo_start) undone &= attempt(&TaskContext::stopHook);
    if (undo_configure) undone &= attempt(&TaskContext::cleanupHook);
    undone &= attempt(&TaskContext::exceptionHook);
    setState(undone ? TaskState::Exception : TaskState::FatalError);
    return {false, lastError()};
}

// -- cycles -----------------------------------------------------------------------------------------------------------

void TaskContext::update() {
    activity_->call([this] {
        while (cycle()) {
        }
    });
}

void TaskContext::failCycle(const char* hook, std::exception_ptr thrown) {
    // The hook may have requested transitions itself before it threw: what they undid is not undone again.
    if (state() == TaskState::Exception || state() == TaskState::FatalError)
        return setLastError(lastError() + "; then " + hook + ": " + toText(thrown));
    const bool configured = state() >= TaskState::Stopped;
    transition_ = "undo a throw";
    fail(hook, thrown, isRunning(), configured);
    transition_ = nullptr;
}

bool TaskContext::triggered() const {
    return std::any_of(inputs_.begin(), inputs_.end(),
                       [](const InputPortBase* port) { return port->triggers() && port->hasNew(); });
}

bool TaskContext::cycle() {
    if (!isRunning() || transition_) return false;
    const bool running = state() == TaskState::Running;
    const uint64_t taken = taken_;
    timing_.begin();
    try {
        running ? updateHook() : errorHook();
    } catch (...) {
        timing_.end();
        failCycle(running ? "updateHook" : "errorHook", std::current_exception());
        return false;
    }
    const double seconds = timing_.end();
    if (!environment_->rehearsing) cycles_.add(seconds);
    return isRunning() && taken_ != taken && triggered();
}

void Event::raise() { owner_.activity().trigger(); }

}  // namespace insonify::framework
