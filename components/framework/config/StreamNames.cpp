#include "components/framework/config/StreamNames.hpp"

#include "components/framework/Deployment.hpp"
#include "components/framework/Properties.hpp"

namespace insonify::framework {
namespace {

/** Null for a task outside of a deployment. */
const Deployment* getDeployment(const TaskContext& task) {
    return dynamic_cast<const Deployment*>(task.environment().deployment);
}

StreamName named(const std::string& path, const DeploymentSpec* spec) {
    const auto [task, object] = splitPort(path);
    const TaskSpec* const known = spec ? spec->task(task) : nullptr;
    return {task, object, known ? known->model() : ""};
}

/** Returns the description of a property, also of a field in a block; null: the task has no such property, so the name
 *  is a port. */
std::optional<PropertyInfo> findProperty(const TaskContext& task, const std::string& name) {
    for (const PropertiesBase* properties : task.properties())
        for (PropertyInfo& info : properties->list())
            if (info.name == name) return std::move(info);
    return std::nullopt;
}

}  // namespace

StreamName streamName(const OutputPortBase& port) {
    const Deployment* const deployment = getDeployment(port.owner());
    const DeploymentSpec* const spec = deployment ? &deployment->spec() : nullptr;
    if (const auto* const stand_in = dynamic_cast<const StandIn*>(&port.owner())) {
        StreamName name = named(stand_in->getStream(port.name()), spec);
        if (const std::string model = stand_in->getModel(port.name()); !model.empty()) name.model = model;
        return name;
    }
    const std::string alias = spec ? spec->getAlias(port.path()) : "";
    return named(alias.empty() ? port.path() : alias, spec);
}

std::map<std::string, std::string> taskModels(const TaskContext& task) {
    std::map<std::string, std::string> models;
    if (const Deployment* const deployment = getDeployment(task))
        for (const TaskSpec& one : deployment->spec().tasks) models[one.name] = one.model();
    return models;
}

std::vector<PropertyAlias> propertyAliases(const TaskContext& task) {
    std::vector<PropertyAlias> all;
    const Deployment* const deployment = getDeployment(task);
    if (!deployment) return all;
    const DeploymentSpec& spec = deployment->spec();
    const auto add = [&](const TaskSpec& owner, const std::string& alias, const std::string& target, bool is_switch) {
        if (alias.find('.') != std::string::npos) return;  // a field of a compound, not a separate property
        const auto [name, property] = splitPort(target);
        const TaskContext* const target_task = deployment->task(name);
        const auto info = target_task ? findProperty(*target_task, property) : std::nullopt;
        if (info)
            all.push_back(
                {{owner.name, alias, owner.model()}, name, property, is_switch, std::string(info->unit) == "deg"});
    };
    for (const TaskSpec& owner : spec.tasks) {
        for (const auto& [alias, target] : owner.aliases) add(owner, alias, target, false);
        for (const auto& [alias, target] : owner.switches) add(owner, alias, target, true);
    }
    return all;
}

}  // namespace insonify::framework
