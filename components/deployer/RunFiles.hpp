#pragma once
#include <filesystem>
#include <string>

#include "components/framework/Deployment.hpp"

namespace insonify::deployer {

/** The time from which on files are of a run that begins now; file systems keep times in steps of some milliseconds. */
std::filesystem::file_time_type runBegin();

/** Lists the files that a run has written, those that differ in their number on one line; the last line names the
 * picture to open first or, without a picture, the command that draws the pings of the log.
 *  @param begin from runBegin() */
std::string filesText(const std::filesystem::path& folder, std::filesystem::file_time_type begin,
                      const framework::Deployment& deployment);

}  // namespace insonify::deployer
