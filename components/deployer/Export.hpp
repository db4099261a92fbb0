#pragma once
// Streams of a log as pictures, and as files of what records sonars.
#include <filesystem>
#include <string>
#include <vector>

#include "components/log/Reader.hpp"
#include "components/output/PictureConfig.hpp"
#include "types/Sonar.hpp"

namespace insonify::deployer {

/** How the pings of a stream are shown, of which one is given: codes where the log knows them as such, and else
 *  negative bins are taken for levels in dB. */
output::DisplayConfig displayFor(const log::Reader& log, const log::Stream& stream, const types::Sonar& ping);

/** Writes the pictures of a stream, x_000000.png and on for `x.png`, and returns the files: fans of pings, beams and
 *  scans, as displayFor decides; waterfalls of a side-scan, 480 lines each; frames as they are.
 *  @param along_ground lines of a side-scan in range along a flat bottom, each by the altitude at its time, of the only
 *  stream of ranges
 *  Throws types::ConfigError for a stream of anything else, std::runtime_error for a frame whose pixels no PNG can
 * hold.
 */
std::vector<std::filesystem::path> exportPictures(log::Reader& log, const std::string& stream,
                                                  const std::filesystem::path& path, bool along_ground = false);

/** Writes the lines of a side-scan as an XTF file (output/Xtf.hpp): whole numbers of 16 bits where the log knows the
 * bins as codes, else the bins as they are. Each line has the pose at its time, or the last before it; that of the
 * vehicle is taken to the sonar by the mount that the log knows.
 *  @param poses stream of the sonar's poses or its vehicle's; empty: the only one of the log, or the only one that a
 *  sonar tells; where there is none the file has no places, which is reported on stderr. Altitudes are those of the
 *  only stream of ranges.
 *  Throws types::ConfigError for a stream of anything but pings of one beam to port and one to starboard, for poses
 * that are none or have to be named, and for a file that cannot be made. */
void exportXtf(log::Reader& log, const std::string& stream, const std::string& poses, const std::filesystem::path& to);

/** Writes codes that go as amplitude as a recording of the viewer of a Blueprint Oculus (device/OculusRecording.hpp),
 *  bin for bin. Throws types::ConfigError for a stream of anything else, and for a file that cannot be made. */
void exportOculus(log::Reader& log, const std::string& stream, const std::filesystem::path& to);

}  // namespace insonify::deployer
