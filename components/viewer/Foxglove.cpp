#include "components/viewer/Foxglove.hpp"

#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "components/console/Json.hpp"

namespace insonify::viewer {
namespace {

using Json = nlohmann::json;

/** Returns whether the value is an unsigned integer of 32 bits. */
bool isId(const Json& value) { return value.is_number_unsigned() && value.get<uint64_t>() <= UINT32_MAX; }

/** Returns an empty list if the key is absent or not a list. */
Json listIn(const Json& message, const char* key) {
    Json list = message.value(key, Json());
    return list.is_array() ? list : Json::array();
}

}  // namespace

std::string serverInfo(const std::string& session) {
    return Json{{"op", "serverInfo"},
                {"name", "Insonify"},
                {"sessionId", session},
                {"capabilities", {"time", "parameters", "parametersSubscribe"}},
                {"supportedEncodings", {"cdr"}},
                {"metadata", Json::object()}}
        .dump();
}

std::string advertise(const std::vector<FoxgloveChannel>& channels) {
    Json list = Json::array();
    for (const FoxgloveChannel& channel : channels)
        list.push_back({{"id", list.size()},
                        {"topic", channel.topic},
                        {"encoding", "cdr"},
                        {"schemaName", channel.schema_name},
                        {"schema", channel.schema},
                        {"schemaEncoding", "ros2msg"}});
    return Json{{"op", "advertise"}, {"channels", list}}.dump();
}

std::string diagnosticText(const std::string& message) {
    return Json{{"op", "status"}, {"level", 2}, {"message", message}}.dump(-1, ' ', false,
                                                                           Json::error_handler_t::replace);
}

std::string messageHead(uint32_t subscription, uint64_t nanoseconds) {
    std::string head(13, '\1');
    std::memcpy(head.data() + 1, &subscription, sizeof subscription);
    std::memcpy(head.data() + 5, &nanoseconds, sizeof nanoseconds);
    return head;
}

std::string timeMessage(uint64_t nanoseconds) {
    std::string message(9, '\2');
    std::memcpy(message.data() + 1, &nanoseconds, sizeof nanoseconds);
    return message;
}

// -- parameters -------------------------------------------------------------------------------------------------------

namespace {

ParameterRequest::Kind getKind(const Json& message) {
    using enum ParameterRequest::Kind;
    const Json op = message.is_object() ? message.value("op", Json()) : Json();
    return op == "getParameters"                 ? Get
           : op == "setParameters"               ? Set
           : op == "subscribeParameterUpdates"   ? Subscribe
           : op == "unsubscribeParameterUpdates" ? Unsubscribe
                                                 : Other;
}

/** Formats a value for a property's setter; texts unchanged. */
std::string yaml(const Json& one) {
    const Json value = one.value("value", Json());
    return value.is_string() ? value.get<std::string>() : value.dump();
}

std::pair<std::string, std::string> setting(const Json& one) {
    if (!one.is_object() || !one.value("name", Json()).is_string())
        throw std::invalid_argument("sets a parameter without a name");
    if (one.value("type", Json()) == "byte_array")
        throw std::invalid_argument("sets " + one["name"].dump() + " to bytes, which no property has");
    return {one["name"].get<std::string>(), yaml(one)};
}

}  // namespace

ParameterRequest readParameterRequest(std::string_view text) {
    const Json message = console::readJson<Json>(text);
    ParameterRequest request;
    request.kind = getKind(message);
    if (request.kind == ParameterRequest::Kind::Other) return request;
    if (const Json id = message.value("id", Json()); id.is_string()) request.id = id.get<std::string>();
    if (request.kind == ParameterRequest::Kind::Set) {
        for (const Json& one : listIn(message, "parameters")) request.values.push_back(setting(one));
        return request;
    }
    for (const Json& name : listIn(message, "parameterNames")) {
        if (!name.is_string()) throw std::invalid_argument("names a parameter with a value that is not a text");
        request.names.push_back(name.get<std::string>());
    }
    return request;
}

std::string parameterValues(const Parameters& parameters, const std::optional<std::string>& id) {
    Json list = Json::array();
    for (const auto& [name, value] : parameters) {
        Json one = {{"name", name}, {"value", Json::parse(value)}};
        if (one["value"].is_number_float()) one["type"] = "float64";
        list.push_back(std::move(one));
    }
    Json message = {{"op", "parameterValues"}, {"parameters", list}};
    if (id) message["id"] = *id;
    return message.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void ParameterSubscriptions::take(const ParameterRequest& request) {
    const bool on = request.kind == ParameterRequest::Kind::Subscribe;
    if (request.names.empty()) {
        all_ = on;
        names_.clear();
    }
    for (const std::string& name : request.names)
        if (on == all_)
            names_.erase(name);
        else
            names_.insert(name);
}

// -- subscriptions ----------------------------------------------------------------------------------------------------

std::string Subscriptions::take(std::string_view text) {
    const Json message = console::readJson<Json>(text);
    if (!message.is_object() || !message.contains("op") || !message["op"].is_string())
        return "is not a JSON object with an op";
    if (message["op"] == "unsubscribe") {
        for (const Json& id : listIn(message, "subscriptionIds"))
            if (isId(id)) channel_of_.erase(id.get<uint32_t>());
        return "";
    }
    if (message["op"] != "subscribe") return "";
    for (const Json& one : listIn(message, "subscriptions")) {
        if (!one.is_object() || !isId(one.value("id", Json())) || !isId(one.value("channelId", Json())))
            return "a subscription needs an id and a channelId, both integers";
        if (std::string diagnostic = add(one["id"].get<uint32_t>(), one["channelId"].get<uint32_t>());
            !diagnostic.empty())
            return diagnostic;
    }
    return "";
}

std::string Subscriptions::add(uint32_t id, uint32_t channel) {
    if (channel >= channels_)
        return "there is no channel " + std::to_string(channel) + "; there are " + std::to_string(channels_);
    for (const auto& [other, subscribed] : channel_of_)
        if (subscribed == channel && other != id)
            return "channel " + std::to_string(channel) + " has subscription " + std::to_string(other) +
                   " already; a client has one for each channel";
    channel_of_[id] = channel;
    return "";
}

}  // namespace insonify::viewer
