#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/device/Bytes.hpp"

namespace insonify::mavlink {

using device::Bytes;

/** One frame of MAVLink.
 *
 *  Version 1: 0xFE, length, sequence, system, component, u8 message, payload, sum. Version 2: 0xFD, length, two bytes
 * of flags, sequence, system, component, u24 message, payload without the zeros at its end, sum, and a signature of 13
 *  bytes where the first flag says so. The sum is CRC-16/MCRF4XX of all behind the first byte and of the message's own
 *  CRC_EXTRA. Little endian. */
struct Frame {
    int version = 2;
    uint8_t sequence = 0;
    uint8_t system = 0, component = 0;  ///< Whose it is.
    uint32_t message = 0;
    Bytes payload;  ///< At most 255 bytes.

    /** As it is sent, without a signature. */
    Bytes bytes(uint8_t crc_extra) const;
    friend bool operator==(const Frame&, const Frame&) = default;
};

/** What is known of a message. */
struct Kind {
    uint32_t message = 0;
    uint8_t crc_extra = 0;
    size_t size = 0;  ///< Of the payload in version 1, without what came later [bytes].
};

/** CRC-16/MCRF4XX, begun or carried on. */
uint16_t crc(std::span<const uint8_t> bytes, uint16_t from = 0xffff);

struct Datagram {
    std::vector<Frame> frames;  ///< Those that are whole and of a kind.
    std::string diagnostic;     ///< The first thing that is wrong with its bytes; empty: nothing.
};

/** The frames of a datagram, as far as they are of one of these kinds: no others can be checked, and they are passed
 *  over by their length.
 *
 *  What begins like a frame and does not add up is passed over by a byte, so that a frame within it is found. A
 *  signature is passed over: it is a secret of the sender's and its ground station's. Unknown flags that must be
 *  understood make a frame unreadable, as MAVLink has it. */
Datagram readDatagram(std::span<const uint8_t> bytes, std::span<const Kind> kinds);

}  // namespace insonify::mavlink
