#pragma once
#include <concepts>
#include <optional>
#include <string>

#include "components/device/wire/Framer.hpp"

namespace insonify::device {

/** One frame of Blue Robotics' ping protocol, little endian: 'B', 'R', u16 length of the payload, u16 message, u8
 *  source, u8 destination, payload, u16 sum of all bytes before. */
struct PingFrame {
    uint16_t message = 0;
    uint8_t source = 0;       ///< Sending device; 0: a program.
    uint8_t destination = 0;  ///< Receiving device; 0: any.
    Bytes payload;            ///< At most 65,535 bytes.

    Bytes bytes() const;
    friend bool operator==(const PingFrame&, const PingFrame&) = default;
};

/** Finds frames in the bytes of a line, with anything between them.
 *
 *  An incomplete frame is waited for, unless a complete frame follows within its bytes: a false beginning delays
 *  nothing. */
class PingFrameReader final : public Framer {
public:
    /** @param max_payload a longer payload is not accepted: at most tens of bytes to a device, 1,220 from it [bytes] */
    explicit PingFrameReader(size_t max_payload) : Framer(CutOff::IsPassedOver), max_payload_(max_payload) {}

    /** Returns the next frame, if there is one. */
    std::optional<PingFrame> next();

private:
    size_t getSize(std::span<const uint8_t> bytes) const override;

    size_t max_payload_;
};

/** Returns every frame of one datagram. */
std::vector<PingFrame> pingFrames(std::span<const uint8_t> datagram, size_t max_payload);

/** Writes the fields of a message into a payload, in order. */
class PingPayloadWriter {
public:
    explicit PingPayloadWriter(Bytes& payload) : payload_(payload) {}
    template <class... Fields>
    void operator()(const Fields&... fields) {
        (put(fields), ...);
    }

private:
    template <std::integral T>
    void put(T value) {
        append(payload_, value);
    }
    void put(const std::string& text);
    void put(const Bytes& data);  ///< Preceded by its u16 length.

    Bytes& payload_;
};

/** Reads the fields of a message from a payload, in order; missing fields keep their values. */
class PingPayloadReader {
public:
    explicit PingPayloadReader(std::span<const uint8_t> payload) : payload_(payload) {}
    template <class... Fields>
    void operator()(Fields&... fields) {
        (take(fields), ...);
    }
    /** Whether no field was missing. */
    bool complete() const { return complete_; }

private:
    template <std::integral T>
    void take(T& value) {
        if (!has(sizeof value)) return;
        value = read<T>(payload_, at_);
        at_ += sizeof value;
    }
    void take(std::string& text);  ///< The rest of the payload.
    void take(Bytes& data);        ///< Preceded by its u16 length.
    bool has(size_t size);

    std::span<const uint8_t> payload_;
    size_t at_ = 0;
    bool complete_ = true;
};

/** Returns the bytes of a message's frame. */
template <class Message>
Bytes pingBytes(const Message& message, uint8_t source = 0, uint8_t destination = 0) {
    PingFrame frame{Message::message, source, destination, {}};
    PingPayloadWriter writer(frame.payload);
    Message::describe(message, writer);
    return frame.bytes();
}

/** Returns the message of a frame; none for another message or a missing field. Bytes after the last field are
 *  ignored. */
template <class Message>
std::optional<Message> pingMessage(const PingFrame& frame) {
    Message message;
    PingPayloadReader reader(frame.payload);
    Message::describe(message, reader);
    if (frame.message != Message::message || !reader.complete()) return {};
    return message;
}

// Messages of every device. Each lists its fields in the order of the wire, once for both directions: pingBytes writes
// them, pingMessage reads them.

struct PingAck {
    static constexpr uint16_t message = 1;
    uint16_t acked = 0;

    static void describe(auto& self, auto& visit) { visit(self.acked); }
};

struct PingNack {
    static constexpr uint16_t message = 2;
    uint16_t nacked = 0;
    std::string text;

    static void describe(auto& self, auto& visit) { visit(self.nacked, self.text); }
};

struct PingText {
    static constexpr uint16_t message = 3;
    std::string text;

    static void describe(auto& self, auto& visit) { visit(self.text); }
};

enum class PingDeviceType : uint8_t { Unknown = 0, Ping1d = 1, Ping360 = 2 };

struct PingDeviceInformation {
    static constexpr uint16_t message = 4;
    uint8_t type = 0;  ///< PingDeviceType, or a later type.
    uint8_t revision = 0, major = 0, minor = 0, patch = 0, reserved = 0;

    static void describe(auto& self, auto& visit) {
        visit(self.type, self.revision, self.major, self.minor, self.patch, self.reserved);
    }
};

struct PingProtocolVersion {
    static constexpr uint16_t message = 5;
    uint8_t major = 1, minor = 0, patch = 0, reserved = 0;

    static void describe(auto& self, auto& visit) { visit(self.major, self.minor, self.patch, self.reserved); }
};

/** Requests a message. */
struct PingGeneralRequest {
    static constexpr uint16_t message = 6;
    uint16_t requested = 0;

    static void describe(auto& self, auto& visit) { visit(self.requested); }
};

struct PingSetDeviceId {
    static constexpr uint16_t message = 100;
    uint8_t device_id = 0;

    static void describe(auto& self, auto& visit) { visit(self.device_id); }
};

}  // namespace insonify::device
