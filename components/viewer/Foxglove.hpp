#pragma once
// Foxglove's WebSocket protocol, version 1, as far as a server of channels, time and parameters speaks it. Its newer
// name, foxglove.sdk.v1, is that of the same messages.
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace insonify::viewer {

inline constexpr const char* foxglove_protocol = "foxglove.websocket.v1";
inline constexpr const char* foxglove_sdk_protocol = "foxglove.sdk.v1";

/** What clients may subscribe to; its id is its place in the list. */
struct FoxgloveChannel {
    std::string topic;        ///< "/sonar/ping"
    std::string schema_name;  ///< "sensor_msgs/Image"
    std::string schema;       ///< The whole text.
};

/** @param session another one after each start of the server, so that clients know a connection that came back. */
std::string serverInfo(const std::string& session);
std::string advertise(const std::vector<FoxgloveChannel>& channels);
/** Level 2 is an error. */
std::string diagnosticText(const std::string& message);

/** 0x01, subscription, time, all little endian: goes before the message. */
std::string messageHead(uint32_t subscription, uint64_t nanoseconds);

/** 0x02, time, little endian: what the server's clock shows. */
std::string timeMessage(uint64_t nanoseconds);

/** A property of a task, "sonar.range", and its value in JSON. */
using Parameters = std::vector<std::pair<std::string, std::string>>;

/** What a client asks of parameters. */
struct ParameterRequest {
    enum class Kind { Other, Get, Set, Subscribe, Unsubscribe } kind = Kind::Other;
    std::optional<std::string> id;   ///< Comes back in the answer.
    std::vector<std::string> names;  ///< Of all but Set; empty: all.
    Parameters values;               ///< Of Set, in YAML.
};
/** Other for what is none. Throws std::invalid_argument with what is wrong with one. */
ParameterRequest readParameterRequest(std::string_view text);
std::string parameterValues(const Parameters& parameters, const std::optional<std::string>& id);

/** Of which parameters a client is told when they change. */
class ParameterSubscriptions {
public:
    void take(const ParameterRequest& request);
    bool contains(const std::string& name) const { return all_ ? !names_.contains(name) : names_.contains(name); }
    bool any() const { return all_ || !names_.empty(); }

private:
    bool all_ = false;
    std::set<std::string> names_;  ///< These; when all are, all but these.
};

/** Which subscription of a client is for which channel: one for each channel at most. */
class Subscriptions {
public:
    explicit Subscriptions(size_t channels) : channels_(channels) {}
    /** Takes what a client says; gives what is wrong with it, nothing when all is well. Messages that are of the
     *  protocol but not for this server change nothing. */
    std::string take(std::string_view text);
    const std::map<uint32_t, uint32_t>& all() const { return channel_of_; }  ///< Channel by subscription.

private:
    std::string add(uint32_t id, uint32_t channel);

    size_t channels_;
    std::map<uint32_t, uint32_t> channel_of_;
};

}  // namespace insonify::viewer
