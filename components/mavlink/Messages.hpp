#pragma once
// Messages of MAVLink's common set, as far as poses need them. Each lists its fields in the order of the wire, which is
// not that of the definitions: the largest come first. Of version 2 the fields that were added later are left out.
#include <algorithm>
#include <array>
#include <optional>

#include "components/mavlink/Frame.hpp"

namespace insonify::mavlink {

/** Who is there, once a second. */
struct Heartbeat {
    static constexpr Kind kind{0, 50, 9};
    static constexpr const char* name = "HEARTBEAT";
    uint32_t custom_mode = 0;
    uint8_t type = 0, autopilot = 0, base_mode = 0, system_status = 0, version = 3;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(self.custom_mode, self.type, self.autopilot, self.base_mode, self.system_status, self.version);
    }
};

/** How the vehicle lies: the quaternion turns vectors of the body (x forward, y right, z down) into the world (north,
 *  east, down); rates are those about the body's axes [rad/s]. */
struct AttitudeQuaternion {
    static constexpr Kind kind{31, 246, 32};
    static constexpr const char* name = "ATTITUDE_QUATERNION";
    uint32_t time_boot_ms = 0;
    float w = 1, x = 0, y = 0, z = 0;
    float roll_speed = 0, pitch_speed = 0, yaw_speed = 0;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(self.time_boot_ms, self.w, self.x, self.y, self.z, self.roll_speed, self.pitch_speed, self.yaw_speed);
    }
};

/** Where the vehicle is, and how fast: north, east, down of the origin of its estimate [m, m/s]. */
struct LocalPositionNed {
    static constexpr Kind kind{32, 185, 28};
    static constexpr const char* name = "LOCAL_POSITION_NED";
    uint32_t time_boot_ms = 0;
    float x = 0, y = 0, z = 0, vx = 0, vy = 0, vz = 0;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(self.time_boot_ms, self.x, self.y, self.z, self.vx, self.vy, self.vz);
    }
};

/** What something beside the autopilot says of the vehicle's pose: north, east, down [m], and the angles of its body (x
 *  forward, y right, z down) by yaw, then pitch, then roll [rad]. */
struct VisionPositionEstimate {
    static constexpr Kind kind{102, 158, 32};
    static constexpr const char* name = "VISION_POSITION_ESTIMATE";
    uint64_t usec = 0;
    float x = 0, y = 0, z = 0, roll = 0, pitch = 0, yaw = 0;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(self.usec, self.x, self.y, self.z, self.roll, self.pitch, self.yaw);
    }
};

/** Asks for something to be done. */
struct CommandLong {
    static constexpr Kind kind{76, 152, 33};
    static constexpr const char* name = "COMMAND_LONG";
    static constexpr uint16_t set_message_interval = 511;  ///< Parameters: message, interval [us].
    std::array<float, 7> parameters{};
    uint16_t command = 0;
    uint8_t target_system = 0, target_component = 0, confirmation = 0;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        for (auto& parameter : self.parameters) visit(parameter);
        visit(self.command, self.target_system, self.target_component, self.confirmation);
    }
};

/** Those that are heard: heartbeats tell that somebody is there. */
inline constexpr std::array heard_kinds{Heartbeat::kind, AttitudeQuaternion::kind, LocalPositionNed::kind,
                                        VisionPositionEstimate::kind};

/** Writes fields behind each other. */
struct PayloadWriter {
    Bytes& payload;
    template <class... Fields>
    void operator()(const Fields&... fields) {
        (device::append(payload, fields), ...);
    }
};

/** Reads fields one behind the other from bytes that are all there. */
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

/** A message as a frame. */
template <class Message>
Frame frameOf(const Message& message, uint8_t system, uint8_t component, uint8_t sequence = 0, int version = 2) {
    Frame frame{version, sequence, system, component, Message::kind.message, {}};
    PayloadWriter writer{frame.payload};
    Message::describe(message, writer);
    return frame;
}

/** The message of a frame; none where it is another one. Zeros that version 2 leaves out at the end are put back, and
 *  fields that were added later are passed over. */
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
