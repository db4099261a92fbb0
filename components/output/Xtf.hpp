#pragma once
// The bytes of an XTF file (eXtended Triton Format, Triton Imaging, revision 41), as far as side-scans need them: a
// header of 1024 bytes, then for each ping a header of 256, and for each side one of 64 and its samples. Little endian.
#include <cstdint>
#include <string>
#include <vector>

#include "types/Describe.hpp"
#include "types/Pose.hpp"
#include "types/Sonar.hpp"

namespace insonify::output {

/** Numbers of a line: whole ones of 16 bits, which every program reads, or the bins as they are. */
enum class XtfSamples { Uint16, Float32 };

/** What holds for a whole file. */
struct XtfFormat {
    XtfSamples samples = XtfSamples::Uint16;
    double frequency_khz = 0;  ///< 0: unknown.
    std::string name;          ///< Of the file.
};

/** What a ping's record tells beside its lines. */
struct XtfPing {
    types::Pose sonar;      ///< In the world; not finite: unknown.
    double altitude = 0;    ///< Above the bottom [m]; 0: unknown.
    double since_last = 0;  ///< [s]
    uint32_t number = 0;    ///< [1]
};

/** The header of a file whose pings look like this one. */
std::vector<char> xtfHeader(const XtfFormat& format, const types::Sonar& ping);

/** Appends a ping: port, then starboard, whose beams are those of the first bearing above and below 0. Port runs from
 *  the far end to the sonar and starboard from the sonar to the far end, as they lie in a picture. Places are metres
 *  east and north, headings degrees from north clockwise, pitch positive bow up, roll positive to starboard.
 *  Throws std::invalid_argument for a ping without two sides, and with Uint16 for bins that are no whole numbers from 0
 *  to 65535. */
void appendXtfPing(const XtfFormat& format, const types::Sonar& ping, const XtfPing& more, std::vector<char>& bytes);

}  // namespace insonify::output

template <>
struct insonify::types::EnumNames<insonify::output::XtfSamples> {
    static constexpr std::string_view names[] = {"uint16", "float32"};
};
