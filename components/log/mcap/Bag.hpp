#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "components/log/mcap/ChunkWriter.hpp"

namespace insonify::log::mcap {

/** Reliable, volatile, the last ten. It stands in channels and in metadata.yaml: where the two differ, readers may find
 *  no message. */
extern const std::string qos_profile;

/** The file metadata.yaml, by which `ros2 bag` knows a folder's MCAP files as one bag. */
class Bag {
public:
    /** Throws ConfigError when the folder of the bag's first file holds the metadata.yaml of another bag. */
    explicit Bag(const std::filesystem::path& first_file);

    void add(const FileSummary& finished) { finished_.push_back(finished); }
    /** Writes metadata.yaml, with the file that is being written as it is now. Throws std::runtime_error with the
     *  system's reason. */
    void write(const ChunkWriter& present) const;

private:
    std::string text(const ChunkWriter& present) const;

    std::filesystem::path path_;
    std::vector<FileSummary> finished_;
};

}  // namespace insonify::log::mcap
