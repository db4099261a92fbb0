#pragma once
// Messages of the ping protocol that every device has. Each lists its fields in the order of the wire, once for both
// directions: pingBytes writes it, pingMessage reads it.
#include "components/device/PingProtocol.hpp"

namespace insonify::device {

struct PingAck {
    static constexpr uint16_t message = 1;
    uint16_t acked = 0;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(self.acked);
    }
};

struct PingNack {
    static constexpr uint16_t message = 2;
    uint16_t nacked = 0;
    std::string text;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(self.nacked, self.text);
    }
};

struct PingText {
    static constexpr uint16_t message = 3;
    std::string text;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(self.text);
    }
};

enum class PingDeviceType : uint8_t { Unknown = 0, Ping1d = 1, Ping360 = 2 };

struct PingDeviceInformation {
    static constexpr uint16_t message = 4;
    uint8_t type = 0;  ///< PingDeviceType, or one that came later.
    uint8_t revision = 0, major = 0, minor = 0, patch = 0, reserved = 0;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(self.type, self.revision, self.major, self.minor, self.patch, self.reserved);
    }
};

struct PingProtocolVersion {
    static constexpr uint16_t message = 5;
    uint8_t major = 1, minor = 0, patch = 0, reserved = 0;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(self.major, self.minor, self.patch, self.reserved);
    }
};

/** Asks for a message. */
struct PingGeneralRequest {
    static constexpr uint16_t message = 6;
    uint16_t requested = 0;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(self.requested);
    }
};

struct PingSetDeviceId {
    static constexpr uint16_t message = 100;
    uint8_t device_id = 0;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(self.device_id);
    }
};

}  // namespace insonify::device
