#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "components/device/wire/Bytes.hpp"

namespace insonify::mavlink {

using device::Bytes;

/** One frame of MAVLink.
 *
 *  Version 1: 0xFE, length, sequence, system, component, u8 message, payload, sum. Version 2: 0xFD, length, two bytes
 *  of flags, sequence, system, component, u24 message, payload without trailing zeros, sum, and a signature of 13 bytes
 *  if the first flag is set. The sum is CRC-16/MCRF4XX of all bytes behind the first and of the message's CRC_EXTRA.
 *  Little endian. */
struct Frame {
    int version = 2;
    uint8_t sequence = 0;
    uint8_t system = 0, component = 0;  ///< The sender.
    uint32_t message = 0;
    Bytes payload;  ///< At most 255 bytes.

    /** Returns the bytes to send, without a signature. */
    Bytes bytes(uint8_t crc_extra) const;
    friend bool operator==(const Frame&, const Frame&) = default;
};

/** A known kind of message. */
struct Kind {
    uint32_t message = 0;
    uint8_t crc_extra = 0;
    size_t size = 0;  ///< Size of the payload in version 1, without extension fields [bytes].
};

/** Returns the CRC-16/MCRF4XX of bytes, started or continued from `from`. */
uint16_t crc(std::span<const uint8_t> bytes, uint16_t from = 0xffff);

struct Datagram {
    std::vector<Frame> frames;  ///< Valid frames of a known kind.
    std::string diagnostic;     ///< The first error in the bytes; empty when there is none.
};

/** Returns the frames of a datagram that are of one of these kinds. Other frames cannot be checked, and are skipped by
 *  their length.
 *
 *  A frame with a wrong checksum is skipped by a byte, so that a frame within it is found. Signatures are ignored:
 *  their key is a secret of the sender and its ground station. Unknown incompatibility flags make a frame unreadable,
 *  as MAVLink defines them. */
Datagram readDatagram(std::span<const uint8_t> bytes, std::span<const Kind> kinds);

}  // namespace insonify::mavlink
