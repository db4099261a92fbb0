#pragma once
// Export of a log's streams to pictures and to file formats of sonar recorders.
#include <filesystem>
#include <string>
#include <vector>

#include "components/deployer/Json.hpp"
#include "components/framework/config/DeploymentSpec.hpp"
#include "components/log/Reader.hpp"
#include "components/output/tasks/PictureConfig.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::deployer {

/** Returns the deployment that wrote the log, from the metadata of its first stream; empty where it is unknown or
 *  unreadable. */
framework::DeploymentSpec getDeployment(const log::Reader& log);

/** Returns what the numbers of a stream mean, by the deployment in its metadata, with the properties at the log's first
 * sample where the property log is next to it (those of `--set`).
 *
 *  Pings: {stream, bins, output, model, reference, tvg, gain_db, code, noise, frequency_khz, speed_of_sound_m_s or
 *  null, range_m, bin_duration, frame, mount: {position [m], roll_deg, pitch_deg, yaw_deg}, quaternion_order, seed};
 *  what is not configured is null. Poses: {stream, position, orientation, quaternion_order}. Truth, returns and
 *  elements of pings: {stream, a text for each field; objects: the names of the truth's objects, where known}. Points:
 *  {stream, points, intensity; datum: the world's origin, where known}. Others: {stream, type}. */
Json readMeaning(const log::Reader& log, const log::Stream& stream);

/** Returns the stream if it has at least one ping. Throws types::ConfigError for other streams, with the expectation
 *  `wanted`. */
const log::Stream& getPings(const log::Reader& log, const std::string& stream, const char* wanted);

/** Returns the frequency in the metadata of a stream of pings [kHz]; 0: unknown. */
double getFrequency(const Json& meaning);

/** Returns how the pings of a stream are shown, of which `ping` is one. Bins are codes where the log records them as
 *  codes. Otherwise negative bins are levels in dB. */
output::DisplayConfig displayFor(const log::Reader& log, const log::Stream& stream, const types::Sonar& ping);

/** Writes the pictures of a stream, x_000000.png and on for `x.png`, and returns the files. Pings, beams and scans
 *  become fans, as displayFor decides; a side-scan becomes waterfalls of 480 lines; frames are copied.
 *  @param along_ground shows the lines of a side-scan in range along a flat bottom, each by the altitude at its time,
 *  from the only stream of ranges
 *  Throws types::ConfigError for a stream of another type, std::runtime_error for a frame whose pixels do not fit a
 *  PNG. */
std::vector<std::filesystem::path> exportPictures(log::Reader& log, const std::string& stream,
                                                  const std::filesystem::path& path, bool along_ground = false);

/** Writes the lines of a side-scan as an XTF file (recordings/Xtf.hpp): 16-bit whole numbers where the log records the
 * bins as codes, else the bins unchanged. Each line has the pose at its time, or the last pose before it. A vehicle's
 * pose is transformed to the sonar by the mount in the log.
 *  @param poses stream of the poses of the sonar or its vehicle; empty: the only stream of poses, or the only one that
 *  a sonar writes. Without poses the file has no positions, which is reported on stderr. Altitudes are those of the
 *  only stream of ranges.
 *  Throws types::ConfigError for a stream that is not pings of one beam to port and one to starboard, for `poses` that
 *  is not a stream of poses or must be named, and for a file that cannot be made. */
void exportXtf(log::Reader& log, const std::string& stream, const std::string& poses, const std::filesystem::path& to);

/** Writes codes of amplitude as a recording of the viewer of a Blueprint Oculus (device/OculusRecording.hpp), bin for
 *  bin. Throws types::ConfigError for a stream of another type, and for a file that cannot be made. */
void exportOculus(log::Reader& log, const std::string& stream, const std::filesystem::path& to);

}  // namespace insonify::deployer
