#pragma once
// Foxglove's WebSocket protocol, version 1, as far as a server without parameters and services speaks it.
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace insonify::viewer {

inline constexpr const char* foxglove_protocol = "foxglove.websocket.v1";

/** What clients may subscribe to; its id is its place in the list. */
struct FoxgloveChannel {
    std::string topic;        ///< "/sonar/ping"
    std::string schema_name;  ///< "sensor_msgs/Image"
    std::string schema;       ///< The whole text.
};

std::string serverInfo();
std::string advertise(const std::vector<FoxgloveChannel>& channels);
/** Level 2 is an error. */
std::string diagnosticText(const std::string& message);

/** 0x01, subscription, time, all little endian: goes before the message. */
std::string messageHead(uint32_t subscription, uint64_t nanoseconds);

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
