#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "components/console/Json.hpp"
#include "components/viewer/Publisher.hpp"

namespace insonify::viewer {
namespace {

using Json = nlohmann::json;

/** Replaces invalid UTF-8. */
std::string dump(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json numberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json valueOf(const types::PropertyValue& value) {
    return std::visit([](const auto& held) { return Json(held); }, value);
}

/** Hides tokens, because clients may be shown to others. */
Json shown(const std::string& name, const types::PropertyValue& value) {
    const auto* text = std::get_if<std::string>(&value);
    const bool is_secret = name == "token" || name.ends_with(".token");
    return is_secret && text && !text->empty() ? Json("...") : valueOf(value);
}

Json planOf(const types::Plan& plan) {
    Json omitted = Json::array();
    for (const types::Omission& omission : plan.omitted)
        omitted.push_back({{"name", omission.name}, {"reason", omission.reason}});
    return {{"features", plan.features}, {"passes", plan.passes},
            {"omitted", omitted},        {"notices", types::lines(plan.notices)},
            {"rows", plan.rows},         {"columns_per_beam", plan.columns_per_beam},
            {"slabs", plan.slabs},       {"predicted_error", numberOrNull(plan.predicted_error)},
            {"device", plan.device}};
}

Json taskOf(const types::TaskStatus& task) {
    Json properties = Json::object(), outputs = Json::array();
    for (const auto& [name, value] : task.record.properties) properties[name] = shown(name, value);
    for (const types::PortStatus& port : task.outputs)
        outputs.push_back({{"name", port.name}, {"type", port.type}, {"written", port.written}});
    Json json = {{"name", task.record.name}, {"type", task.record.type}, {"state", task.state},
                 {"error", task.error},      {"cycle_s", task.cycle_s},  {"latency_s", numberOrNull(task.latency_s)},
                 {"outputs", outputs},       {"properties", properties}};
    if (task.playback) json["playback"] = {{"at_s", task.playback->at_s}, {"length_s", task.playback->length_s}};
    if (task.plan) json["plan"] = planOf(*task.plan);
    return json;
}

}  // namespace

std::string statusText(const types::DeploymentStatus& status, const ServerCounts& counts) {
    Json tasks = Json::array(), connections = Json::array();
    for (const types::TaskStatus& task : status.tasks) tasks.push_back(taskOf(task));
    for (const types::ConnectionStatus& one : status.connections)
        connections.push_back({{"from", one.from},
                               {"to", one.to},
                               {"policy", one.policy},
                               {"lost", one.lost},
                               {"passed_over", one.passed_over}});
    return dump({{"type", "status"},
                 {"now_us", status.now.microseconds},
                 {"sent_s", std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count()},
                 {"lockstep", status.lockstep},
                 {"paused", status.paused},
                 {"tasks", tasks},
                 {"connections", connections},
                 {"clients", counts.clients},
                 {"refused", counts.refused},
                 {"dropped", counts.dropped}});
}

Parameters parametersOf(const types::DeploymentStatus& status) {
    Parameters parameters;
    for (const types::TaskStatus& task : status.tasks)
        for (const auto& [name, value] : task.record.properties)
            parameters.emplace_back(task.record.name + "." + name, dump(shown(name, value)));
    return parameters;
}

std::string interfacesText(const std::vector<types::TaskInterface>& interfaces, bool control) {
    Json tasks = Json::array();
    for (const types::TaskInterface& task : interfaces) {
        Json properties = Json::array();
        for (const types::PropertyInfo& info : task.properties)
            properties.push_back({{"name", info.name},
                                  {"type", info.type},
                                  {"unit", info.unit},
                                  {"doc", info.doc},
                                  {"min", numberOrNull(info.min)},
                                  {"max", numberOrNull(info.max)}});
        tasks.push_back({{"name", task.name}, {"properties", properties}, {"operations", task.operations}});
    }
    return dump({{"type", "interfaces"}, {"control", control}, {"tasks", tasks}});
}

void readRequest(const std::string& text, Request& request) {
    const Json said = console::readJson<Json>(text);
    if (!said.is_object()) throw std::invalid_argument("is not a JSON object");
    const Json id = said.value("id", Json(0u));
    if (!id.is_number_unsigned()) throw std::invalid_argument("id is not an integer");
    request.id = id.get<uint64_t>();
    if (said.contains("pause") && said["pause"].is_boolean()) {
        request.kind = Request::Kind::Pause;
        request.on = said["pause"].get<bool>();
    } else if (said.contains("step")) {
        request.kind = Request::Kind::Step;
    } else if (said.contains("call") && said["call"].is_string()) {
        request.operation = said["call"].get<std::string>();
        const Json arguments = said.value("arguments", Json::array());
        if (!arguments.is_array()) throw std::invalid_argument("arguments are not a list");
        for (const Json& argument : arguments) {
            if (!argument.is_string()) throw std::invalid_argument("an argument is not a text");
            request.arguments.push_back(argument.get<std::string>());
        }
    } else {
        throw std::invalid_argument("has none of call, pause (true, false) and step");
    }
}

std::string answerText(uint64_t id, const std::string& result) {
    return dump({{"type", "answer"}, {"id", id}, {"result", result}});
}

std::string refusalText(uint64_t id, const std::string& why) {
    return dump({{"type", "answer"}, {"id", id}, {"refused", why}});
}

}  // namespace insonify::viewer
