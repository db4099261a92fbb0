#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "components/framework/Deployment.hpp"

namespace insonify::deployer {

/** What changes when a file is written. */
struct FileState {
    uintmax_t size = 0;                       ///< [bytes]
    std::filesystem::file_time_type written;  ///< In nanoseconds, by a clock that may be set meanwhile.

    bool operator==(const FileState&) const = default;
};

/** The files of a folder and of the folders in it, by name relative to the folder. */
using FolderListing = std::map<std::filesystem::path, FileState>;

/** Lists a folder; a folder that is missing or cannot be read has no files. */
FolderListing listFolder(const std::filesystem::path& folder);

/** Returns the files that are new or others since a listing, by name; without the indices of logs. Compares no time
 *  with a clock, so that a step of the clock hides no file and shows no other. */
std::vector<std::filesystem::path> writtenSince(const FolderListing& before, const std::filesystem::path& folder);

/** Lists the files that a run has written, those that differ in their number on one line; the last line names the
 * picture to open first or, without a picture, the command that draws the pings of the log.
 *  @param before of the folder, before the run */
std::string filesText(const std::filesystem::path& folder, const FolderListing& before,
                      const framework::Deployment& deployment);

}  // namespace insonify::deployer
