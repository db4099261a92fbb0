#pragma once
// UDP messages and log files of a Water Linked Sonar 3D-15: the Range Image Protocol.
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "components/device/wire/Bytes.hpp"
#include "types/Time.hpp"

namespace insonify::device {

/** The fields that both kinds of images have. Rows are ordered from the lowest elevation up, pixels from port to
 *  starboard; the outermost pixels look along the edges of the field of view. */
struct RipImage {
    types::Time time;
    uint32_t sequence = 0;           ///< Number of the ping.
    float speed_of_sound = 0;        ///< [m/s]
    float range = 0;                 ///< [m]
    uint32_t frequency_hz = 0;       ///< [Hz]
    uint32_t width = 0;              ///< Pixels of a row.
    uint32_t height = 0;             ///< Rows.
    float field_of_view_deg = 0;     ///< From the first column to the last.
    float vertical_opening_deg = 0;  ///< From the lowest row to the highest.
};

/** A message `RangeImage`: distances. */
struct RangePixels : RipImage {
    float pixel_scale = 0;         ///< Slant range of pixel value 1 [m].
    std::vector<uint32_t> pixels;  ///< 16 bits; 0: no echo.
};

/** A message `BitmapImageGreyscale8`: strengths of the echoes, 100 log10(S / 30), where S has 15 bits. */
struct StrengthPixels : RipImage {
    uint32_t type = 0;  ///< 0: strengths; 1: a shaded picture of the distances.
    Bytes pixels;       ///< 0: no echo.
};

/** A message of which only the name is known. */
struct OtherRipMessage {
    std::string type;
};

using RipMessage = std::variant<RangePixels, StrengthPixels, OtherRipMessage>;

enum class RipVersion { Rip1, Rip2 };     ///< Uncompressed, or compressed by snappy.
constexpr size_t max_rip_packet = 65507;  ///< Max size of a datagram's payload [bytes].

/** Returns one packet. It may exceed a datagram if the image has more than about 16,000 pixels. */
Bytes ripPacket(const RangePixels& image, RipVersion version = RipVersion::Rip2);
Bytes ripPacket(const StrengthPixels& image, RipVersion version = RipVersion::Rip2);

/** Returns every message in these bytes, in order. The bytes are a datagram, or packets with anything between them, as
 *  in log files. Packets that contradict themselves (missing bytes, a wrong checksum or number of pixels) are skipped.
 *  @param diagnostics receives one line for each skipped packet, up to 100, unless null */
std::vector<RipMessage> ripMessages(std::span<const uint8_t> bytes, std::vector<std::string>* diagnostics = nullptr);

}  // namespace insonify::device
