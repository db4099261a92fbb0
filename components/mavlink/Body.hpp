#pragma once
#include <algorithm>
#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "components/device/wire/Network.hpp"
#include "components/mavlink/Frame.hpp"
#include "types/SenderClock.hpp"
#include "types/samples/Pose.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Describe.hpp"

namespace insonify::mavlink {

// The messages of MAVLink's common set that poses need. Each lists its fields in the order of the wire, by decreasing
// size, which differs from the order of the definitions. Extension fields of version 2 are omitted.
/** Announces a component, once a second. */
struct Heartbeat {
    static constexpr Kind kind{0, 50, 9};
    static constexpr const char* name = "HEARTBEAT";
    uint32_t custom_mode = 0;
    uint8_t type = 0, autopilot = 0, base_mode = 0, system_status = 0, version = 3;

    static void describe(auto& self, auto& visit) {
        visit(self.custom_mode, self.type, self.autopilot, self.base_mode, self.system_status, self.version);
    }
};

/** The attitude of the vehicle. The quaternion rotates vectors of the body (x forward, y right, z down) into the world
 *  (north, east, down); rates are about the body's axes [rad/s]. */
struct AttitudeQuaternion {
    static constexpr Kind kind{31, 246, 32};
    static constexpr const char* name = "ATTITUDE_QUATERNION";
    uint32_t time_boot_ms = 0;
    float w = 1, x = 0, y = 0, z = 0;
    float roll_speed = 0, pitch_speed = 0, yaw_speed = 0;

    static void describe(auto& self, auto& visit) {
        visit(self.time_boot_ms, self.w, self.x, self.y, self.z, self.roll_speed, self.pitch_speed, self.yaw_speed);
    }
};

/** Position and velocity of the vehicle: north, east, down of the origin of its estimate [m, m/s]. */
struct LocalPositionNed {
    static constexpr Kind kind{32, 185, 28};
    static constexpr const char* name = "LOCAL_POSITION_NED";
    uint32_t time_boot_ms = 0;
    float x = 0, y = 0, z = 0, vx = 0, vy = 0, vz = 0;

    static void describe(auto& self, auto& visit) {
        visit(self.time_boot_ms, self.x, self.y, self.z, self.vx, self.vy, self.vz);
    }
};

/** An estimate of the vehicle's pose by a component other than the autopilot: north, east, down [m], and the angles of
 *  the body (x forward, y right, z down) by yaw, then pitch, then roll [rad]. */
struct VisionPositionEstimate {
    static constexpr Kind kind{102, 158, 32};
    static constexpr const char* name = "VISION_POSITION_ESTIMATE";
    uint64_t usec = 0;
    float x = 0, y = 0, z = 0, roll = 0, pitch = 0, yaw = 0;

    static void describe(auto& self, auto& visit) {
        visit(self.usec, self.x, self.y, self.z, self.roll, self.pitch, self.yaw);
    }
};

/** Sends a command. */
struct CommandLong {
    static constexpr Kind kind{76, 152, 33};
    static constexpr const char* name = "COMMAND_LONG";
    static constexpr uint16_t set_message_interval = 511;  ///< Parameters: message, interval [us].
    std::array<float, 7> parameters{};
    uint16_t command = 0;
    uint8_t target_system = 0, target_component = 0, confirmation = 0;

    static void describe(auto& self, auto& visit) {
        for (auto& parameter : self.parameters) visit(parameter);
        visit(self.command, self.target_system, self.target_component, self.confirmation);
    }
};

/** The messages that are received. A heartbeat reveals a vehicle that sends nothing else. */
inline constexpr std::array received_kinds{Heartbeat::kind, AttitudeQuaternion::kind, LocalPositionNed::kind,
                                           VisionPositionEstimate::kind};

/** Appends fields to a payload. */
struct PayloadWriter {
    Bytes& payload;
    template <class... Fields>
    void operator()(const Fields&... fields) {
        (device::append(payload, fields), ...);
    }
};

/** Reads consecutive fields from a payload that has all of them. */
struct PayloadReader {
    std::span<const uint8_t> payload;
    size_t at = 0;
    template <class... Fields>
    void operator()(Fields&... fields) {
        (take(fields), ...);
    }
    template <class T>
    void take(T& field) {
        field = device::read<T>(payload, at);
        at += sizeof field;
    }
};

/** Returns a message as a frame. */
template <class Message>
Frame getFrame(const Message& message, uint8_t system, uint8_t component, uint8_t sequence = 0, int version = 2) {
    Frame frame{version, sequence, system, component, Message::kind.message, {}};
    PayloadWriter writer{frame.payload};
    Message::describe(message, writer);
    return frame;
}

/** Returns the message of a frame; none when the frame has another message. Restores the trailing zeros that version 2
 *  omits, and ignores extension fields. */
template <class Message>
std::optional<Message> makeMessage(const Frame& frame) {
    if (frame.message != Message::kind.message) return {};
    std::array<uint8_t, Message::kind.size> payload{};
    std::copy_n(frame.payload.begin(), std::min(payload.size(), frame.payload.size()), payload.begin());
    Message message;
    PayloadReader reader{payload};
    Message::describe(message, reader);
    return message;
}

/** The messages that make a pose. */
enum class Source {
    Estimate,  ///< ATTITUDE_QUATERNION and LOCAL_POSITION_NED: the estimate of an autopilot.
    Vision     ///< VISION_POSITION_ESTIMATE: the estimate of another component.
};

/** The source of the poses of one output port. */
struct BodyConfig {
    std::string port = "pose";
    Source source = Source::Estimate;
    int system_id = 1;
    std::optional<int> component_id = {};

    static void describe(auto& self, auto& visit) {
        visit({"port", "", "output port of the poses"}, self.port);
        visit({"source", "",
               "estimate: ATTITUDE_QUATERNION with LOCAL_POSITION_NED, of an autopilot; vision: "
               "VISION_POSITION_ESTIMATE"},
              self.source);
        visit({"system_id", "", "of the vehicle", 1, 255}, self.system_id);
        visit({"component_id", "", "of the sender; absent: any, one at a time", 1, 255}, self.component_id);
    }
};

/** The request for a vehicle's messages. */
struct RequestConfig {
    double rate = 20;

    static void describe(auto& self, auto& visit) { visit({"rate", "Hz", "of each message", 2, 1000}, self.rate); }
};

struct PoseConfig {
    std::string address = "127.0.0.1";
    int port = 14550;
    std::vector<BodyConfig> bodies;
    glm::dvec3 origin{0};
    std::optional<RequestConfig> request = {};

    static void describe(auto& self, auto& visit) {
        visit({"address", "", "numeric address to listen on; 0.0.0.0: every network of this machine"}, self.address);
        visit({"port", "1", "of UDP; 0: any free port, printed in a notice", 0, 65535}, self.port);
        visit({"bodies", "", "bodies whose poses are read"}, self.bodies);
        visit({"origin", "m", "position of the messages' origin in the world: x north, y west, z up"}, self.origin);
        visit({"request", "",
               "requests messages that a vehicle does not send, by SET_MESSAGE_INTERVAL; absent: nothing is ever "
               "sent"},
              self.request);
    }
    void check(types::Diagnostics& diagnostics) const {
        device::checkAddress(diagnostics, address);
        if (bodies.empty()) diagnostics.push_back({"bodies", "is empty; must hold a body"});
        std::set<std::string> ports;
        for (size_t i = 0; i < bodies.size(); ++i)
            if (!ports.insert(bodies[i].port).second)
                diagnostics.push_back(
                    {"bodies[" + std::to_string(i) + "].port", "is " + bodies[i].port + " a second time"});
    }
};

/** Return poses in our axes (world x north, y west, z up; body x forward, y left, z up) from messages in MAVLink's
 *  axes. Values that the message does not have are unknown; the time is 0. */
types::Pose getPose(const AttitudeQuaternion& attitude, const LocalPositionNed& position);
types::Pose getPose(const VisionPositionEstimate& estimate);

/** The sender of a message. The same component at two addresses counts as two senders. */
struct Sender {
    uint64_t way = 0;  ///< A number for each address that datagrams arrive from.
    uint8_t component = 0;
    friend bool operator==(const Sender&, const Sender&) = default;
};

/** Makes poses from the messages of one body.
 *
 *  Every attitude gives a pose: with the newest position, extrapolated by its velocity to the time of the attitude,
 *  which is at most `max_gap` away. Both times count from the same boot, by 32 bits of milliseconds that wrap around
 *  after 49.7 days. Every vision estimate is a pose. SenderClock converts stamps to our clock. Only one sender counts
 *  at a time, until it has been silent for `max_silence`. */
class Body {
public:
    static constexpr types::Time max_gap{500'000};
    static constexpr types::Time max_silence{1'000'000};  ///< Silence of a sender before another is accepted.
    static constexpr types::Time patience{2'000'000};     ///< Time until a missing half of an estimate is reported.

    Body(const BodyConfig& config, glm::dvec3 origin) : config_(config), origin_(origin) {}

    struct Taken {
        std::optional<types::Pose> pose;
        std::string diagnostic;  ///< Why the message was dropped; empty when it was not.
    };
    /** Returns whether the frame is a message of this body's source and of this body. */
    bool isInPart(const Frame& frame) const;
    /** Returns whether this body's source uses the message. */
    bool wants(uint32_t message) const;
    Taken take(const Frame& frame, uint64_t way, types::Time now);
    /** Returns the messages of the source that have not arrived recently. */
    std::vector<uint32_t> missing(types::Time now) const;
    const BodyConfig& config() const { return config_; }

private:
    Taken take(const AttitudeQuaternion& attitude, types::Time now);
    Taken take(const LocalPositionNed& position, types::Time now);
    Taken take(const VisionPositionEstimate& estimate, types::Time now);
    /** Returns the pose at a stamp of the sender's clock, relative to the world's origin. */
    Taken stamped(types::Pose pose, const types::SenderClock::Reading& reading) const;
    /** Returns a diagnostic when one half of an estimate has been arriving without the other for `patience`. */
    std::string incomplete(const char* came, const char* lacks, types::Time now);
    /** Returns the time since boot without the wrap-around after 49.7 days. */
    types::Time sinceBoot(uint32_t milliseconds) const;
    bool listensTo(const Sender& sender, types::Time now);

    BodyConfig config_;
    glm::dvec3 origin_;
    std::optional<Sender> sender_;
    types::Time sender_came_, attitude_came_, position_came_, vision_came_;
    std::optional<types::Time> incomplete_since_;
    std::optional<LocalPositionNed> position_;
    std::optional<uint32_t> boot_ms_;  ///< Stamp of the newest attitude.
    types::Time since_boot_;           ///< The same without wrap-around.
    types::SenderClock clock_;
};

}  // namespace insonify::mavlink

template <>
struct insonify::types::EnumNames<insonify::mavlink::Source> {
    static constexpr std::string_view names[] = {"estimate", "vision"};
};
