#include "components/viewer/Foxglove.hpp"

#include <cstring>
#include <nlohmann/json.hpp>

#include "components/viewer/ReadJson.hpp"

namespace insonify::viewer {
namespace {

using Json = nlohmann::json;

/** A whole number of 32 bits. */
bool isId(const Json& value) { return value.is_number_unsigned() && value.get<uint64_t>() <= UINT32_MAX; }

/** Empty when there is none, or something else. */
Json listIn(const Json& said, const char* key) {
    Json list = said.value(key, Json());
    return list.is_array() ? list : Json::array();
}

}  // namespace

std::string serverInfo() {
    return Json{{"op", "serverInfo"},
                {"name", "Insonify"},
                {"capabilities", Json::array()},
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

std::string Subscriptions::take(std::string_view text) {
    const Json said = readJson(text);
    if (!said.is_object() || !said.contains("op") || !said["op"].is_string()) return "is no JSON object with an op";
    if (said["op"] == "unsubscribe") {
        for (const Json& id : listIn(said, "subscriptionIds"))
            if (isId(id)) channel_of_.erase(id.get<uint32_t>());
        return "";
    }
    if (said["op"] != "subscribe") return "";
    for (const Json& one : listIn(said, "subscriptions")) {
        if (!one.is_object() || !isId(one.value("id", Json())) || !isId(one.value("channelId", Json())))
            return "a subscription has an id and a channelId, whole numbers";
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
