#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "components/log/mcap/ChunkWriter.hpp"

namespace insonify::log::mcap {

/** Reliable, volatile, the last ten. Channels and metadata.yaml have this text; where the two differ, readers may find
 *  no message. */
extern const std::string qos_profile;

/** The file metadata.yaml, with which `ros2 bag` reads a folder's MCAP files as one bag. */
class Bag {
public:
    /** Throws ConfigError when the folder of the bag's first file has the metadata.yaml of another bag. */
    explicit Bag(const std::filesystem::path& first_file);

    void add(const FileSummary& finished) { finished_.push_back(finished); }
    /** Writes metadata.yaml, with the present state of the open file. Throws std::runtime_error with the system's
     *  reason. */
    void write(const ChunkWriter& present) const;

private:
    std::string text(const ChunkWriter& present) const;

    std::filesystem::path path_;
    std::vector<FileSummary> finished_;
};

}  // namespace insonify::log::mcap
