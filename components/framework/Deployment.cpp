#include "components/framework/Deployment.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "components/framework/Activity.hpp"
#include "components/framework/Lockstep.hpp"
#include "components/framework/RealtimeThread.hpp"
#include "components/framework/Wiring.hpp"

namespace insonify::framework {
namespace {

constexpr const char* sonar_type = "/base/samples/Sonar";

template <class Ports>
bool hasSonar(const Ports& ports) {
    return std::any_of(ports.begin(), ports.end(), [](const auto* port) { return port->typeName() == sonar_type; });
}

bool hasFailed(const TaskContext& task) {
    return task.state() == TaskState::Exception || task.state() == TaskState::FatalError;
}

bool holdsSamples(const TaskContext& task) {
    const auto& inputs = task.inputs();
    return std::any_of(inputs.begin(), inputs.end(), [](const auto* port) { return port->hasNew(); });
}

/** Tells what a task found wrong with its properties at the place where they stand. */
void reportOf(const TaskSpec& spec, const types::Diagnostic& diagnostic, ConfigReader& reader) {
    const bool names_task = diagnostic.path.starts_with(spec.name + ".");
    const std::string path = names_task ? diagnostic.path.substr(spec.name.size() + 1) : diagnostic.path;
    const bool has_properties = spec.properties.IsDefined();
    reader.report(has_properties ? spec.properties : spec.place, spec.path() + ".properties",
                  {{path, diagnostic.message}});
}

}  // namespace

uint64_t seedOf(uint64_t seed, const std::string& task) {
    uint64_t hash = 0xcbf29ce484222325;  // FNV-1a of the name, then splitmix64 with the seed
    for (const char c : task) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    hash += seed * 0x9e3779b97f4a7c15;
    hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9;
    hash = (hash ^ (hash >> 27)) * 0x94d049bb133111eb;
    return (hash ^ (hash >> 31)) >> 11;
}

Deployment::Deployment(DeploymentSpec spec, Registry& registry, std::filesystem::path output_folder, uint64_t seed)
    : spec_(std::move(spec)), environment_(std::make_shared<Environment>()) {
    const auto folder = std::filesystem::path(spec_.file).parent_path();
    environment_->input_folder = folder.empty() ? "." : folder;
    environment_->output_folder = std::move(output_folder);
    environment_->lockstep = spec_.lockstep;
    environment_->deployment_text = spec_.text;
    environment_->seed = seed;
    environment_->warn = [this](const std::string& text) { warn(text); };
    environment_->deployment = this;
    start_ = types::Time::fromSeconds(spec_.start_time);
    setClock();
    Wiring(*this, registry).make(seed);
    environment_->records = [this] {
        std::vector<types::TaskRecord> records;
        for (const auto& task : tasks_) {
            records.push_back(task->record());
            records.back().type = spec_.task(task->name())->type;
        }
        return records;
    };
    for (const auto& task : tasks_) task->refreshRecord();
    startAtFirstStamp();
    followClock();
    for (const auto& task : tasks_)
        for (const OutputPortBase* port : task->outputs())
            if (port->typeName() == sonar_type && !hasSonar(task->inputs())) sonars_.push_back(port);
}

Deployment::~Deployment() { cleanup(); }

void Deployment::setClock() {
    simulated_us_ = start_.microseconds;
    environment_->start_time = [this] { return start_; };
    if (spec_.lockstep) environment_->now = [this] { return types::Time{simulated_us_.load()}; };
}

void Deployment::startAtFirstStamp() {
    std::optional<types::Time> first;
    for (const auto& task : tasks_)
        if (const auto next = task->nextTime()) first = std::min(first.value_or(*next), *next);
    start_ = first.value_or(start_);
    simulated_us_ = start_.microseconds;
}

void Deployment::followClock() {
    if (spec_.lockstep) return;
    for (const auto& task : tasks_)
        if (auto clock = task->clock(environment_->now)) {
            environment_->now = std::move(clock);
            environment_->wall_clock = false;
        }
}

TaskContext* Deployment::task(const std::string& name) const {
    for (const auto& task : tasks_)
        if (task->name() == name) return task.get();
    return nullptr;
}

void Deployment::configure() {
    ConfigReader reader(spec_.file);
    types::Diagnostics elsewhere;
    for (const auto& task : tasks_) {
        const Outcome outcome = task->configure();
        if (outcome) continue;
        const TaskSpec& spec = *spec_.task(task->name());
        if (!task->configError())
            reader.report(spec.place, spec.path(), outcome.reason);
        else
            for (const types::Diagnostic& diagnostic : task->configError()->diagnostics())
                diagnostic.file.empty() ? reportOf(spec, diagnostic, reader) : elsewhere.push_back(diagnostic);
    }
    types::Diagnostics diagnostics = reader.diagnostics();
    diagnostics.insert(diagnostics.end(), elsewhere.begin(), elsewhere.end());
    if (diagnostics.empty()) return;
    cleanup();
    throw types::ConfigError(diagnostics);
}

RunResult Deployment::run(const RunLimits& limits, const std::atomic<bool>& stop,
                          const std::function<void(const Progress&)>& progress) {
    RunResult result;
    wall_start_ = std::chrono::steady_clock::now();
    stood_still_ = {};
    warnings_.clear();
    for (const std::string& line : spec_.unused()) warn(line);
    if (!spec_.lockstep) prepareRealtime();
    {
        std::optional<Watchdog> watchdog;
        if (!spec_.lockstep) watchdog.emplace(watchdogLimits(), [this](const std::string& text) { warn(text); });
        if (startAll(result.failures))
            spec_.lockstep ? runLockstep(limits, stop, progress) : runRealtime(limits, stop, progress);
        noteBroken(result.failures);
        stopAll(result.failures);
    }
    if (!spec_.lockstep && spec_.lock_memory) unlockMemory();
    result.warnings = warnings_;
    const Progress end = progressNow();
    result.pings = end.pings;
    result.elapsed_s = end.elapsed_s;
    result.wall_s = end.wall_s;
    return result;
}

void Deployment::prepareRealtime() {
    if (spec_.lock_memory)
        if (const std::string refused = lockMemory(); !refused.empty()) warn(refused);
    for (const auto& task : tasks_)
        task->activity().call([&] {
            for (const std::string& refused : applyToThread(task->activity().settings()))
                warn(task->name() + ": " + refused);
        });
    start_ = environment_->now();
}

std::vector<Watchdog::Limit> Deployment::watchdogLimits() const {
    std::vector<Watchdog::Limit> limits;
    for (const auto& task : tasks_) {
        const double own = task->activity().settings().watchdog;
        limits.push_back({task.get(), own > 0 ? own : spec_.watchdog});
    }
    return limits;
}

void Deployment::warn(const std::string& text) {
    constexpr size_t at_most = 100;
    std::lock_guard lock(warning_mutex_);
    if (warnings_.size() < at_most) warnings_.push_back(text);
    if (told_) told_(text);
}

void Deployment::runLockstep(const RunLimits& limits, const std::atomic<bool>& stop,
                             const std::function<void(const Progress&)>& progress) {
    Lockstep lockstep(tasks_, order_, start_);
    const bool limited = limits.pings > 0 || limits.duration_s > 0;
    const types::Time end = limits.duration_s > 0 ? start_ + types::Time::fromSeconds(limits.duration_s)
                                                  : types::Time{std::numeric_limits<int64_t>::max()};
    const auto next = [&] {
        const auto held = betweenInstants();
        return lockstep.next();
    };
    for (types::Time instant = next(); !stop && instant < end; instant = next()) {
        standStill(stop);
        keepPace(limits.pace, instant, stop);
        while (callers_ > 0 && !stop) std::this_thread::sleep_for(std::chrono::microseconds(100));
        {
            const auto held = betweenInstants();
            if (!takeStep()) continue;                // paused meanwhile
            const types::Time due = lockstep.next();  // another, where a log was sought in meanwhile
            if (due >= end) return;
            simulated_us_ = due.microseconds;
            lockstep.step();
        }
        if (progress) progress(progressNow());
        if (broken(limits) || reached(limits)) return;
        // With a limit a trajectory goes on holding its end; a log that has been played gives nothing more.
        if (lockstep.sourcesFinished() && (!limited || !lockstep.sourcesWrote())) return;
    }
}

void Deployment::keepPace(double pace, types::Time instant, const std::atomic<bool>& stop) const {
    if (pace <= 0) return;
    using Seconds = std::chrono::duration<double>;
    const Seconds due((instant - start_).seconds() / pace);
    for (Seconds left = due; !stop && !standsStill() && left.count() > 0;
         left = due - (std::chrono::steady_clock::now() - wall_start_ - stood_still_))
        std::this_thread::sleep_for(std::min(left, Seconds(0.02)));
}

void Deployment::runRealtime(const RunLimits& limits, const std::atomic<bool>& stop,
                             const std::function<void(const Progress&)>& progress) {
    while (!stop && !broken(limits) && !reached(limits)) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        if (limits.duration_s > 0 && progressNow().elapsed_s >= limits.duration_s) return;
        if (progress) progress(progressNow());
    }
}

bool Deployment::reached(const RunLimits& limits) const { return limits.pings > 0 && pings() >= limits.pings; }

bool Deployment::broken(const RunLimits& limits) const {
    if (std::any_of(tasks_.begin(), tasks_.end(), [](const auto& task) { return hasFailed(*task); })) return true;
    // A sonar that is in error gives no ping to count.
    return limits.pings > 0 && std::any_of(sonars_.begin(), sonars_.end(), [](const auto* port) {
               return port->owner().state() == TaskState::RunTimeError;
           });
}

void Deployment::noteBroken(std::vector<std::string>& failures) const {
    for (const auto& task : tasks_)
        if (hasFailed(*task)) failures.push_back(task->name() + ": " + task->lastError());
}

bool Deployment::startAll(std::vector<std::string>& failures) {
    for (auto task = order_.rbegin(); task != order_.rend(); ++task) {
        const Outcome outcome = (*task)->start();
        if (!outcome) {
            if (!hasFailed(**task)) failures.push_back((*task)->name() + ": " + outcome.reason);
            return false;
        }
        if (!spec_.lockstep) (*task)->activity().release();
    }
    return true;
}

void Deployment::stopAll(std::vector<std::string>& failures) {
    for (TaskContext* task : order_)
        if (task->isRunning()) stopOne(*task, failures);
}

void Deployment::stopOne(TaskContext& task, std::vector<std::string>& failures) {
    task.activity().hold();
    if (holdsSamples(task)) task.update();
    const bool in_error = task.state() == TaskState::RunTimeError;
    if (in_error) failures.push_back(task.name() + ": " + task.lastError());
    if (task.isRunning()) task.stop();
    if (hasFailed(task)) failures.push_back(task.name() + ": " + task.lastError());
}

std::vector<std::string> Deployment::cleanup() {
    std::vector<std::string> failures;
    stopAll(failures);
    for (TaskContext* task : order_) {
        if (task->state() != TaskState::Stopped) continue;
        if (const Outcome outcome = task->cleanup(); !outcome) failures.push_back(task->name() + ": " + outcome.reason);
    }
    return failures;
}

std::map<std::string, uint64_t> Deployment::losses() const {
    std::map<std::string, uint64_t> losses;
    for (const Connection& connection : connections_) losses[connection.text()] = connection.channel->lost();
    return losses;
}

uint64_t Deployment::pings() const {
    if (sonars_.empty()) return 0;
    const auto fewer = [](const auto* a, const auto* b) { return a->written() < b->written(); };
    return (*std::min_element(sonars_.begin(), sonars_.end(), fewer))->written();
}

Progress Deployment::progressNow() const {
    const auto wall = std::chrono::steady_clock::now() - wall_start_;
    return {pings(), (environment_->now() - start_).seconds(), std::chrono::duration<double>(wall).count()};
}

}  // namespace insonify::framework
