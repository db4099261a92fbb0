#pragma once
// Foxglove's WebSocket protocol, version 1: the part for servers of channels, time and parameters. Its newer name,
// foxglove.sdk.v1, denotes the same messages.
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

/** A channel that clients may subscribe to; its id is its index in the list. */
struct FoxgloveChannel {
    std::string topic;        ///< "/sonar/ping"
    std::string schema_name;  ///< "sensor_msgs/Image"
    std::string schema;       ///< The full text.
};

/** @param session changes with each start of the server, so that clients can recognise a restart */
std::string serverInfo(const std::string& session);
std::string advertise(const std::vector<FoxgloveChannel>& channels);
/** Returns the text of a status message; level 2 is an error. */
std::string diagnosticText(const std::string& message);

/** Returns 0x01, subscription and time, little endian: the header of a message. */
std::string messageHead(uint32_t subscription, uint64_t nanoseconds);

/** Returns 0x02 and the time of the server's clock, little endian. */
std::string timeMessage(uint64_t nanoseconds);

/** Properties of tasks, as "sonar.range", and their values in JSON. */
using Parameters = std::vector<std::pair<std::string, std::string>>;

/** A client's request about parameters. */
struct ParameterRequest {
    enum class Kind { Other, Get, Set, Subscribe, Unsubscribe } kind = Kind::Other;
    std::optional<std::string> id;   ///< Repeated in the answer.
    std::vector<std::string> names;  ///< For all kinds except Set; empty: all.
    Parameters values;               ///< For Set, in YAML.
};
/** Returns Other for other messages. Throws std::invalid_argument with what is wrong with a request. */
ParameterRequest readParameterRequest(std::string_view text);
std::string parameterValues(const Parameters& parameters, const std::optional<std::string>& id);

/** The parameters whose changes are sent to a client. */
class ParameterSubscriptions {
public:
    void take(const ParameterRequest& request);
    bool contains(const std::string& name) const { return all_ ? !names_.contains(name) : names_.contains(name); }
    bool any() const { return all_ || !names_.empty(); }

private:
    bool all_ = false;
    std::set<std::string> names_;  ///< The subscribed names; if all are subscribed, the names excluded.
};

/** A client's subscriptions: at most one for each channel. */
class Subscriptions {
public:
    explicit Subscriptions(size_t channels) : channels_(channels) {}
    /** Handles a client's message; returns what is wrong with it, or an empty text. Messages of the protocol that this
     *  server does not use change nothing. */
    std::string take(std::string_view text);
    const std::map<uint32_t, uint32_t>& all() const { return channel_of_; }  ///< Channel by subscription.

private:
    std::string add(uint32_t id, uint32_t channel);

    size_t channels_;
    std::map<uint32_t, uint32_t> channel_of_;
};

}  // namespace insonify::viewer
