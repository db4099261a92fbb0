#pragma once
// The messages of MAVLink's common set that poses need. Each lists its fields in the order of the wire, by decreasing
// size, which differs from the order of the definitions. Extension fields of version 2 are omitted.
#include <algorithm>
#include <array>
#include <optional>

#include "components/mavlink/Frame.hpp"

namespace insonify::mavlink {

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
Frame frameOf(const Message& message, uint8_t system, uint8_t component, uint8_t sequence = 0, int version = 2) {
    Frame frame{version, sequence, system, component, Message::kind.message, {}};
    PayloadWriter writer{frame.payload};
    Message::describe(message, writer);
    return frame;
}

/** Returns the message of a frame; none when the frame has another message. Restores the trailing zeros that version 2
 *  omits, and ignores extension fields. */
template <class Message>
std::optional<Message> messageOf(const Frame& frame) {
    if (frame.message != Message::kind.message) return {};
    std::array<uint8_t, Message::kind.size> payload{};
    std::copy_n(frame.payload.begin(), std::min(payload.size(), frame.payload.size()), payload.begin());
    Message message;
    PayloadReader reader{payload};
    Message::describe(message, reader);
    return message;
}

}  // namespace insonify::mavlink
