#include "components/framework/Status.hpp"

#include "components/framework/Offers.hpp"
#include "components/framework/Operation.hpp"
#include "components/framework/Properties.hpp"

namespace insonify::framework {

types::TaskStatus statusOf(const TaskContext& task, const std::string& type) {
    types::TaskStatus status{task.record(),
                             toString(task.state()),
                             task.lastError(),
                             task.timing().lastCycle(),
                             task.timing().lastLatency(),
                             task.recordedPlan(),
                             {}};
    status.record.type = type;
    if (const auto* const player = dynamic_cast<const Player*>(&task)) status.playback = player->playback();
    for (const OutputPortBase* port : task.outputs())
        status.outputs.push_back({port->name(), port->typeName(), port->written()});
    return status;
}

types::ConnectionStatus statusOf(const Connection& connection) {
    const std::string_view policy = types::EnumNames<ConnPolicy::Type>::names[connection.policy.type];
    return {connection.from->path(), connection.to->path(), std::string(policy), connection.channel->lost(),
            connection.channel->passedOver()};
}

types::TaskInterface interfaceOf(const TaskContext& task) {
    types::TaskInterface interface;
    interface.name = task.name();
    for (const PropertiesBase* properties : task.properties())
        for (types::PropertyInfo& info : properties->list())
            if (info.name.find_first_of(".[") == std::string::npos) interface.properties.push_back(std::move(info));
    for (const OperationBase* operation : task.operations())
        interface.operations.push_back(operation->name() + " " + operation->signature());
    return interface;
}

}  // namespace insonify::framework
