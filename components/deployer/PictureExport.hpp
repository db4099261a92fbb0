#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "components/log/Reader.hpp"
#include "components/output/PictureConfig.hpp"
#include "types/Sonar.hpp"

namespace insonify::deployer {

/** How the pings of a ping's stream are shown: negative bins are taken for levels in dB. */
output::DisplayConfig displayFor(const types::Sonar& ping);

/** Writes the pictures of a stream, x_000000.png and on for `x.png`, and returns the files: of pings, beams and scans
 *  their fans, of frames themselves. Negative bins are taken for levels in dB. Throws types::ConfigError for a stream
 *  of anything else, std::runtime_error for a frame whose pixels no PNG can hold. */
std::vector<std::filesystem::path> exportPictures(log::Reader& log, const std::string& stream,
                                                  const std::filesystem::path& path);

}  // namespace insonify::deployer
