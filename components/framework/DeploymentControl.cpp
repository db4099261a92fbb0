// What a deployment tells of itself while it runs, and lets its tasks do to it.
#include <stdexcept>
#include <thread>

#include "components/framework/Deployment.hpp"
#include "components/framework/Operation.hpp"
#include "components/framework/Properties.hpp"

namespace insonify::framework {
namespace {

types::TaskStatus statusOf(const TaskContext& task, const std::string& type) {
    types::TaskStatus status{task.record(),
                             toString(task.state()),
                             task.lastError(),
                             task.timing().lastCycle(),
                             task.timing().lastLatency(),
                             task.recordedPlan(),
                             {}};
    status.record.type = type;
    for (const OutputPortBase* port : task.outputs())
        status.outputs.push_back({port->name(), port->typeName(), port->written()});
    return status;
}

types::TaskInterface interfaceOf(const TaskContext& task) {
    types::TaskInterface interface {
        task.name(), {}, {}
    };
    for (const PropertiesBase* properties : task.properties())
        for (const PropertyInfo& info : properties->list())
            if (info.name.find_first_of(".[") == std::string::npos)
                interface.properties.push_back({info.name, info.type, info.unit, info.doc, info.min, info.max});
    for (const OperationBase* operation : task.operations())
        interface.operations.push_back(operation->name() + " " + operation->signature());
    return interface;
}

}  // namespace

types::DeploymentStatus Deployment::status() const {
    types::DeploymentStatus status{environment_->now(), spec_.lockstep, paused_, {}, {}};
    for (const auto& task : tasks_) status.tasks.push_back(statusOf(*task, spec_.task(task->name())->type));
    for (const Connection& connection : connections_)
        status.connections.push_back({connection.from->path(), connection.to->path(),
                                      std::string(types::EnumNames<ConnPolicy::Type>::names[connection.policy.type]),
                                      connection.channel->lost()});
    return status;
}

std::vector<types::TaskInterface> Deployment::interfaces() const {
    std::vector<types::TaskInterface> interfaces;
    for (const auto& task : tasks_) interfaces.push_back(interfaceOf(*task));
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
            task_name + " has no operation " + name + "; " + suggestion(name, namesOf(owner->operations())));
    const auto held = betweenInstants();
    return called->callText(arguments);
}

std::unique_lock<std::mutex> Deployment::betweenInstants() {
    if (!spec_.lockstep) return {};
    ++callers_;
    std::unique_lock lock(instant_mutex_);
    --callers_;
    return lock;
}

void Deployment::pause(bool on) {
    if (!spec_.lockstep)
        throw std::runtime_error("cannot pause: the deployment runs in realtime; in lockstep, time can stand still");
    const auto held = betweenInstants();
    steps_ = 0;
    paused_ = on;
}

void Deployment::step() {
    if (!paused_) throw std::runtime_error("cannot step: the deployment is not paused");
    ++steps_;
}

bool Deployment::takeStep() {
    if (standsStill()) return false;
    if (paused_) --steps_;
    return true;
}

void Deployment::standStill(const std::atomic<bool>& stop) {
    const auto since = std::chrono::steady_clock::now();
    while (standsStill() && !stop) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    stood_still_ += std::chrono::steady_clock::now() - since;
}

}  // namespace insonify::framework
