#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "components/pocolog/Reader.hpp"

namespace insonify::deployer {

/** Writes the fan picture of each ping of a stream, x_000000.png and on for `x.png`, and returns the files. Negative
 *  bins are taken for levels in dB. Throws types::ConfigError for a stream that holds no pings. */
std::vector<std::filesystem::path> exportFans(pocolog::Reader& log, const std::string& stream,
                                              const std::filesystem::path& path);

}  // namespace insonify::deployer
