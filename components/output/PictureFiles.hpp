#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "components/output/PictureConfig.hpp"
#include "components/output/VideoFile.hpp"
#include "types/Image.hpp"

namespace insonify::output {

/** Whether the name of a file is that of a video: it ends in .avi or .mp4, in any case of letters. */
bool isVideo(const std::filesystem::path& file);

/** A file name with a number, in printf's notation: "fan_%06d.png". */
class FilePattern {
public:
    /** Returns none unless there is exactly one `%`, of the form %d, %Nd or %0Nd with N up to 99, before a final
     *  ".png". */
    static std::optional<FilePattern> parse(const std::string& pattern);

    std::string name(uint64_t number) const;

private:
    std::string before_, after_;
    int width_ = 0;
    char filler_ = ' ';
};

/** Writes a grey, RGB or BGR picture of 8 bits a channel as a PNG file. Throws std::runtime_error with the name of the
 *  file. */
void writePng(const std::filesystem::path& file, const types::Image& picture);

/** Writes a stream of pictures as numbered PNG files, a video, or both. Makes the folders that they need. */
class PictureFiles {
public:
    /** @param folder base of relative names */
    PictureFiles(const RecordingConfig& config, const std::filesystem::path& folder);

    void write(const types::Image& picture);
    void skip() { ++number_; }  ///< Skips a picture's number.
    void close();

private:
    std::filesystem::path folder_;
    std::optional<FilePattern> pattern_;
    std::optional<VideoFile> video_;
    uint64_t number_ = 0;
};

}  // namespace insonify::output
