#pragma once
// What a Water Linked Sonar 3D-15 sends by UDP, and what its log files hold: the Range Image Protocol.
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "components/device/Bytes.hpp"
#include "types/Time.hpp"

namespace insonify::device {

/** What images of either kind tell of their ping. Rows run from the lowest elevation up, each from port to starboard;
 *  the outermost pixels look along the edges of the field of view. */
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
    float pixel_scale = 0;         ///< Slant range of a pixel that is 1 [m].
    std::vector<uint32_t> pixels;  ///< 16 bits; 0: nothing heard.
};

/** A message `BitmapImageGreyscale8`: strengths of what was heard, 100 log10(S / 30), where S has 15 bits. */
struct StrengthPixels : RipImage {
    uint32_t type = 0;  ///< 0: strengths; 1: a shaded picture of the distances.
    Bytes pixels;       ///< 0: nothing heard.
};

/** One of which only the name is known. */
struct OtherRipMessage {
    std::string type;
};

using RipMessage = std::variant<RangePixels, StrengthPixels, OtherRipMessage>;

enum class RipVersion { Rip1, Rip2 };     ///< As it is, or compressed by snappy.
constexpr size_t max_rip_packet = 65507;  ///< What a datagram holds [bytes].

/** One packet. May be longer than a datagram where an image has more than some 16,000 pixels. */
Bytes ripPacket(const RangePixels& image, RipVersion version = RipVersion::Rip2);
Bytes ripPacket(const StrengthPixels& image, RipVersion version = RipVersion::Rip2);

/** Every message in these bytes, in order: a datagram, or packets with anything between them, as in log files. What
 *  begins as a packet and contradicts itself (a length that is not there, a checksum or a number of pixels that is
 *  wrong) is none.
 *  @param diagnostics where not null takes one line for each of these, up to 100 */
std::vector<RipMessage> ripMessages(std::span<const uint8_t> bytes, std::vector<std::string>* diagnostics = nullptr);

}  // namespace insonify::device
