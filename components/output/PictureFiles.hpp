#pragma once
#include <filesystem>
#include <optional>

#include "components/output/FilePattern.hpp"
#include "components/output/PictureConfig.hpp"
#include "components/output/VideoFile.hpp"
#include "types/Image.hpp"

namespace insonify::output {

/** Writes a grey, RGB or BGR picture of 8 bits a channel as a PNG file. @throws std::runtime_error with the name of the
 *  file. */
void writePng(const std::filesystem::path& file, const types::Image& picture);

/** The files of a stream of pictures: numbered PNG files, a video, or both. Makes the folders that they need. */
class PictureFiles {
public:
    /** Names are relative to `folder`. */
    PictureFiles(const RecordingConfig& config, const std::filesystem::path& folder);

    void write(const types::Image& picture);
    void skip() { ++number_; }  ///< Leaves out the next picture's number.
    void close();

private:
    std::filesystem::path folder_;
    std::optional<FilePattern> pattern_;
    std::optional<VideoFile> video_;
    uint64_t number_ = 0;
};

}  // namespace insonify::output
