#pragma once
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

/** Writes the pictures of a stream, x_000000.png and on for `x.png`, and returns the files: of pings, beams and scans
 *  their fans, as displayFor tells, of frames themselves. Throws types::ConfigError for a stream
 *  of anything else, std::runtime_error for a frame whose pixels no PNG can hold. */
std::vector<std::filesystem::path> exportPictures(log::Reader& log, const std::string& stream,
                                                  const std::filesystem::path& path);

}  // namespace insonify::deployer
