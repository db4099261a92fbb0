#include "components/framework/Deployment.hpp"

#include <algorithm>
#include <optional>

#include "components/framework/Offers.hpp"
#include "components/framework/Operation.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Wiring.hpp"
#include "components/framework/execution/LockstepExecutor.hpp"
#include "components/framework/execution/RealtimeExecutor.hpp"

namespace insonify::framework {
namespace {

bool holdsSamples(const TaskContext& task) {
    return std::ranges::any_of(task.inputs(), [](const auto* port) { return port->hasNew(); });
}

/** Reports a task's diagnostic of its properties at the place where they are written. */
void reportDiagnostic(const TaskSpec& spec, const types::Diagnostic& diagnostic, ConfigReader& reader) {
    const bool names_task = diagnostic.path.starts_with(spec.name + ".");
    const std::string path = names_task ? diagnostic.path.substr(spec.name.size() + 1) : diagnostic.path;
    const bool has_properties = spec.properties.IsDefined();
    reader.report(has_properties ? spec.properties : spec.place, spec.path() + ".properties",
                  {{path, diagnostic.message}});
}

void stopTask(TaskContext& task, std::vector<std::string>& failures) {
    task.activity().hold();
    if (holdsSamples(task)) task.update();
    const auto* const waiting = dynamic_cast<const Waits*>(&task);
    const bool in_error = task.state() == TaskState::RunTimeError;
    if (in_error && !(waiting && waiting->waits())) failures.push_back(task.name() + ": " + task.lastError());
    if (task.isRunning()) task.stop();
    if (hasFailed(task)) failures.push_back(task.name() + ": " + task.lastError());
}

/** Returns the earliest time that a ClockSource names. */
std::optional<types::Time> firstTime(const Graph& graph) {
    std::optional<types::Time> first;
    for (const auto& task : graph.tasks())
        if (const auto* source = dynamic_cast<const ClockSource*>(task.get()))
            if (const auto next = source->nextTime()) first = std::min(first.value_or(*next), *next);
    return first;
}

// A deployment's status of a running task; waits for no task.
types::TaskStatus getStatus(const TaskContext& task, const std::string& type) {
    types::TaskStatus status{task.record(),
                             toString(task.state()),
                             task.lastError(),
                             task.timing().lastCycle(),
                             task.timing().lastLatency(),
                             task.recordedPlan(),
                             {}};
    status.record.type = type;
    if (const auto* const player = dynamic_cast<const Player*>(&task)) status.playback = player->playback();
    if (const auto* const recorder = dynamic_cast<const Recorder*>(&task)) status.recording = recorder->recording();
    for (const OutputPortBase* port : task.outputs())
        status.outputs.push_back({port->name(), port->typeName(), port->written()});
    return status;
}

types::ConnectionStatus getStatus(const Connection& connection) {
    const std::string_view policy = types::EnumNames<ConnPolicy::Type>::names[connection.policy.type];
    return {connection.from->path(), connection.to->path(), std::string(policy), connection.channel->lost(),
            connection.channel->passedOver()};
}

types::TaskInterface describeInterface(const TaskContext& task) {
    types::TaskInterface interface;
    interface.name = task.name();
    for (const PropertiesBase* properties : task.properties())
        for (types::PropertyInfo& info : properties->list())
            if (info.name.find_first_of(".[") == std::string::npos) interface.properties.push_back(std::move(info));
    const auto* const adjustable = dynamic_cast<const Adjustable*>(&task);
    for (const types::PropertyInfo& info : interface.properties)
        if (!adjustable || !adjustable->adjusts(info.name)) interface.fixed.push_back(info.name);
    for (const OperationBase* operation : task.operations())
        interface.operations.push_back(operation->name() + " " + operation->signature());
    return interface;
}

}  // namespace

Deployment::Deployment(DeploymentSpec spec, Registry& registry, std::filesystem::path output_folder, uint64_t seed)
    : spec_(std::move(spec)), environment_(std::make_shared<Environment>()) {
    makeEnvironment(std::move(output_folder), seed);
    graph_ = Wiring(spec_, environment_, registry).make(seed);
    environment_->records = [this] { return records(); };
    for (const auto& task : tasks()) task->refreshRecord();
    executor_ = makeExecutor();
}

Deployment::~Deployment() {
    if (!process_.isForked()) {
        cleanup();
        return;
    }
    static_cast<void>(new Graph(std::move(graph_)));  // destructors would wait for threads, and write to the files
    static_cast<void>(executor_.release());
}

void Deployment::makeEnvironment(std::filesystem::path output_folder, uint64_t seed) {
    const auto folder = std::filesystem::path(spec_.file).parent_path();
    environment_->input_folder = folder.empty() ? "." : folder;
    environment_->output_folder = std::move(output_folder);
    environment_->lockstep = spec_.lockstep;
    environment_->deployment_text = spec_.text;
    environment_->seed = seed;
    environment_->names = spec_.names;
    environment_->warn = [this](const std::string& text) { warn(text); };
    environment_->deployment = this;
    // The executor's, once it exists.
    const types::Time start = types::Time::fromSeconds(spec_.start_time);
    environment_->start_time = [start] { return start; };
    if (spec_.lockstep) environment_->now = environment_->start_time;
}

std::unique_ptr<Executor> Deployment::makeExecutor() {
    const types::Time start = firstTime(graph_).value_or(types::Time::fromSeconds(spec_.start_time));
    if (spec_.lockstep) return std::make_unique<LockstepExecutor>(graph_, *environment_, start);
    return std::make_unique<RealtimeExecutor>(graph_, *environment_, start,
                                              RealtimeExecutor::Options{spec_.lock_memory, spec_.watchdog});
}

void Deployment::warn(const std::string& text) noexcept try {
    constexpr size_t at_most = 100;
    std::lock_guard lock(warning_mutex_);
    if (warnings_.size() < at_most) warnings_.push_back(text);
    if (reported_) reported_(text);
} catch (...) {
    // A warning that its receiver cannot take must end neither a task nor a thread.
}

// -- life cycle -------------------------------------------------------------------------------------------------------

void Deployment::configure(const std::function<bool(const TaskContext&)>& chosen) {
    ConfigReader reader(spec_.file);
    types::Diagnostics elsewhere;
    for (const auto& task : tasks()) {
        if (chosen && !chosen(*task)) continue;
        const Outcome outcome = task->configure();
        if (outcome) continue;
        const TaskSpec& spec = *spec_.task(task->name());
        if (!task->configError())
            reader.report(spec.place, spec.path(), outcome.reason);
        else
            for (const types::Diagnostic& diagnostic : task->configError()->diagnostics())
                diagnostic.file.empty() ? reportDiagnostic(spec, diagnostic, reader) : elsewhere.push_back(diagnostic);
    }
    types::Diagnostics diagnostics = reader.diagnostics();
    diagnostics.insert(diagnostics.end(), elsewhere.begin(), elsewhere.end());
    if (diagnostics.empty()) return;
    cleanup();
    throw types::ConfigError(diagnostics);
}

RunResult Deployment::run(const RunLimits& limits, const std::atomic<bool>& stop, const Executor::Report& report) {
    RunResult result;
    {
        std::lock_guard lock(warning_mutex_);
        warnings_.clear();
    }
    environment_->is_shard = limits.shard.has_value();
    for (const std::string& line : spec_.unused()) warn(line);
    {
        struct Run {
            Executor& executor;
            ~Run() { executor.end(); }  // also where begin() has thrown
        } const run{*executor_};
        executor_->begin();
        if (startAll(result.failures)) executor_->run(limits, stop, report);
        noteFailed(result.failures);
        stopAll(result.failures);
    }
    {
        std::lock_guard lock(warning_mutex_);
        result.warnings = warnings_;
    }
    static_cast<Progress&>(result) = executor_->progress();
    for (const OutputPortBase* port : graph_.counted()) result.by_port[port->path()] = port->written();
    return result;
}

std::vector<std::string> Deployment::start() {
    std::vector<std::string> failures;
    executor_->begin();
    if (startAll(failures)) return {};
    noteFailed(failures);
    std::vector<std::string> more = stop();
    failures.insert(failures.end(), more.begin(), more.end());
    return failures;
}

std::vector<std::string> Deployment::stop() {
    std::vector<std::string> failures;
    stopAll(failures);
    executor_->end();
    return failures;
}

bool Deployment::startAll(std::vector<std::string>& failures) {
    for (auto task = order().rbegin(); task != order().rend(); ++task) {
        const Outcome outcome = (*task)->start();
        if (!outcome) {
            if (!hasFailed(**task)) failures.push_back((*task)->name() + ": " + outcome.reason);
            return false;
        }
        executor_->release(**task);
    }
    return true;
}

void Deployment::noteFailed(std::vector<std::string>& failures) const {
    for (const auto& task : tasks())
        if (hasFailed(*task)) failures.push_back(task->name() + ": " + task->lastError());
}

void Deployment::stopAll(std::vector<std::string>& failures) {
    for (TaskContext* task : order())
        if (task->isRunning()) stopTask(*task, failures);
}

std::vector<std::string> Deployment::cleanup() {
    std::vector<std::string> failures;
    stopAll(failures);
    for (TaskContext* task : order()) {
        if (task->state() != TaskState::Stopped) continue;
        if (const Outcome outcome = task->cleanup(); !outcome) failures.push_back(task->name() + ": " + outcome.reason);
    }
    return failures;
}

// -- queries of tasks and of the user ---------------------------------------------------------------------------------

std::vector<types::TaskRecord> Deployment::records() const {
    std::vector<types::TaskRecord> records;
    for (const auto& task : tasks()) {
        records.push_back(task->record());
        records.back().type = spec_.task(task->name())->type;
    }
    return records;
}

types::DeploymentStatus Deployment::status() const {
    types::DeploymentStatus status{environment_->now(), spec_.lockstep, executor_->paused(), {}, {}};
    for (const auto& task : tasks()) status.tasks.push_back(getStatus(*task, spec_.task(task->name())->type));
    for (const Connection& connection : connections()) status.connections.push_back(getStatus(connection));
    return status;
}

std::vector<types::TaskInterface> Deployment::interfaces() const {
    std::vector<types::TaskInterface> interfaces;
    for (const auto& task : tasks()) interfaces.push_back(describeInterface(*task));
    return interfaces;
}

std::string Deployment::call(const std::string& operation, const std::vector<std::string>& arguments) {
    const auto [task_name, name] = splitPort(operation);
    TaskContext* const owner = task(task_name);
    if (!owner)
        throw types::ConfigError("", operation,
                                 "there is no task " + task_name + "; " + suggestion(task_name, spec_.taskNames()));
    OperationBase* const called = owner->operation(name);
    if (!called)
        throw types::ConfigError(
            "", operation,
            task_name + " has no operation " + name + "; " + suggestion(name, getNames(owner->operations())));
    const auto held = executor_->betweenInstants();
    return called->callText(arguments);
}

void Deployment::set(const std::map<std::string, std::string>& values, const std::string& origin) {
    std::vector<std::string> names;
    for (const auto& task : tasks())
        if (!task->properties().empty()) names.push_back(task->name());
    types::Diagnostics diagnostics;
    std::map<std::pair<TaskContext*, PropertiesBase*>, std::map<std::string, std::string>> blocks;
    for (const auto& [property, value] : values) {
        const auto [name, rest] = splitPort(property);
        const auto refuse = [&](const std::string& why) {
            diagnostics.push_back({property + "=" + value, why, origin});
        };
        if (rest.empty())
            refuse("must be task.property");
        else if (std::ranges::count(names, name) == 0)
            refuse("there is no task " + name + "; " + suggestion(name, names));
        else if (rest == "activity" || rest.starts_with("activity."))
            refuse("is no property: an activity can only be changed in the deployment");
        else
            blocks[{task(name), &blockWith(rest, task(name)->properties())}][rest] = value;
    }
    if (!diagnostics.empty()) throw types::ConfigError(diagnostics);
    const auto held = executor_->betweenInstants();
    std::vector<std::function<void()>> undo;
    const auto setBack = [&] {
        for (auto each = undo.rbegin(); each != undo.rend(); ++each) (*each)();
    };
    for (const auto& [where, changes] : blocks) try {
            const auto& [owner, block] = where;
            std::function<void()> put_back;
            owner->activity().call([&, to = block] { put_back = to->setAll(changes); });
            undo.push_back([of = owner, put_back] { of->activity().call([&] { put_back(); }); });
        } catch (const types::ConfigError& error) {
            setBack();
            for (types::Diagnostic each : error.diagnostics()) {
                if (each.file.empty()) each.file = origin;
                each.path = "tasks." + where.first->name() + ".properties." + each.path;
                diagnostics.push_back(std::move(each));
            }
            throw types::ConfigError(diagnostics);
        } catch (...) {
            setBack();
            throw;
        }
}

std::map<std::string, uint64_t> Deployment::losses() const {
    std::map<std::string, uint64_t> losses;
    for (const Connection& connection : connections()) losses[connection.text()] = connection.channel->lost();
    return losses;
}

std::map<std::string, uint64_t> Deployment::passedOver() const {
    std::map<std::string, uint64_t> passed_over;
    for (const Connection& connection : connections())
        passed_over[connection.text()] = connection.channel->passedOver();
    return passed_over;
}

}  // namespace insonify::framework
