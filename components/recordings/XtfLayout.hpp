#pragma once
// Offsets of the fields of an XTF file (eXtended Triton Format, Triton Imaging, revision 41), in bytes from the start
// of their block. Numbers are little endian.
#include <bit>
#include <cstddef>
#include <cstdint>

namespace insonify::recordings::xtf {

static_assert(std::endian::native == std::endian::little,
              "numbers are copied in host order, which must be little endian");

/** The start of the file. A file of more than six channels has a longer header, in units of 1024 bytes. */
namespace file_header {
inline constexpr size_t size = 1024, format = 0, system = 1, program = 2, program_version = 10, sonar = 18, name = 100,
                        nav_units = 164, channel_count = 166, bathymetry_count = 168, channel_infos = 256;
inline constexpr uint8_t mark = 0x7B;               ///< Values of `format`.
inline constexpr uint16_t metres = 0, degrees = 3;  ///< Values of `nav_units`.
}  // namespace file_header

/** A channel in the file header. */
namespace channel_info {
inline constexpr size_t size = 128, type = 0, correction = 2, unipolar = 4, sample_bytes = 6, sample_count = 8,
                        name = 12, frequency = 32, beam_width = 36, beam_height = 44, sample_format = 74;
inline constexpr uint8_t port = 1, starboard = 2;  ///< Values of `type`.
/** Values of `sample_format`. Legacy: integers of `sample_bytes`. */
inline constexpr uint8_t legacy = 0, int32 = 2, int16 = 3, float32 = 5, int8 = 8;
}  // namespace channel_info

/** The start of every packet. */
namespace packet {
inline constexpr size_t size = 14, mark = 0, type = 2, channel_count = 4, bytes = 10, unit = 64;
inline constexpr uint16_t magic = 0xFACE;
inline constexpr uint8_t sonar = 0;  ///< Values of `type`.
}  // namespace packet

/** The header of a packet of a side-scan. `ship` and `sonar` are each y (north, latitude) and x (east, longitude). */
namespace ping_header {
inline constexpr size_t size = 256, year = 14, month = 16, day = 17, day_time = 18, day_of_year = 22, number = 28,
                        sound_speed = 32, computed_sound_speed = 72, ship_speed = 120, ship_heading = 124, ship = 128,
                        fix_time = 148, sonar_speed = 152, sonar = 160, depth = 192, altitude = 196, pitch = 204,
                        roll = 208, heading = 212, computer_time = 236;
}  // namespace ping_header

/** The header of a channel in a side-scan packet; its samples follow. */
namespace channel_header {
inline constexpr size_t size = 64, channel = 0, slant_range = 4, duration = 16, since_last = 20, frequency = 26,
                        sample_count = 42, weight = 58;
}  // namespace channel_header

}  // namespace insonify::recordings::xtf
