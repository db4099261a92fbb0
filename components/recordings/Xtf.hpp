#pragma once
// Writes XTF files (eXtended Triton Format, Triton Imaging, revision 41) of side-scans. A file has a header of 1024
// bytes, then for each ping a header of 256, and for each side a header of 64 and its samples. Little endian.
#include <cstdint>
#include <string>
#include <vector>

#include "types/samples/Pose.hpp"
#include "types/samples/Sonar.hpp"
#include "types/text/Describe.hpp"

namespace insonify::recordings {

/** The type of a line's numbers: integers of 16 bits, which every program reads, or the bins unchanged. */
enum class XtfSamples { Uint16, Float32 };

/** Values of a whole file. */
struct XtfFormat {
    XtfSamples samples = XtfSamples::Uint16;
    double frequency_khz = 0;  ///< 0: unknown.
    std::string name;          ///< Name of the file.
};

/** Values of a ping's record in addition to its lines. */
struct XtfPing {
    types::Pose sonar;      ///< In the world; not finite: unknown.
    double altitude = 0;    ///< Above the bottom [m]; 0: unknown.
    double since_last = 0;  ///< Negative where the clock was set back; written as 0 [s].
    uint32_t number = 0;    ///< [1]
};

/** Returns the header of a file whose pings have the shape of this one. */
std::vector<char> xtfHeader(const XtfFormat& format, const types::Sonar& ping);

/** Appends a ping: port, then starboard, the first beams with bearings above and below 0. As in a picture, port is
 *  stored from the far end to the sonar and starboard from the sonar to the far end. Places are metres east and north,
 *  headings degrees from north clockwise, pitch positive bow up, roll positive to starboard. Throws
 *  std::invalid_argument for a ping without two sides, and with Uint16 for bins that are not integers from 0 to
 *  65535. */
void appendXtfPing(const XtfFormat& format, const types::Sonar& ping, const XtfPing& more, std::vector<char>& bytes);

}  // namespace insonify::recordings

template <>
struct insonify::types::EnumNames<insonify::recordings::XtfSamples> {
    static constexpr std::string_view names[] = {"uint16", "float32"};
};
