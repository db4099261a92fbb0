#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "components/output/VideoFile.hpp"
#include "components/output/tasks/PictureConfig.hpp"
#include "types/samples/Image.hpp"

namespace insonify::output {

enum class FileContent { Picture, Video, SideScan };

/** A format of the files that tasks write: a line of the table in PictureFiles.cpp, from which messages are made. */
struct FileFormat {
    std::string_view ending;  ///< In lower case.
    FileContent content;
    void (*write)(const std::filesystem::path&, const types::Image&) = nullptr;  ///< Writes a picture; else null.
    std::string_view codec{};  ///< Of a video: four letters of OpenCV; MJPG is written without FFmpeg.
};
/** Returns the format of a file by its ending, in any case of letters; null: none with this content has it. */
const FileFormat* findFileFormat(const std::filesystem::path& file, FileContent content);
/** Returns the endings of files with this content as a message lists them: ".avi or .mp4". */
std::string fileEndings(FileContent content);

/** A file name with a number, in printf's notation: "fan_%06d.png". */
class FilePattern {
public:
    /** Returns none unless there is exactly one `%`, of the form %d, %Nd or %0Nd with N up to 99, before the ending
     *  of a picture. */
    static std::optional<FilePattern> parse(const std::string& pattern);

    std::string name(uint64_t number) const;
    const FileFormat& format() const { return *format_; }

private:
    const FileFormat* format_ = nullptr;
    std::string before_, after_;
    int width_ = 0;
    char filler_ = ' ';
};

/** Writes a grey, RGB or BGR picture of 8 bits a channel as a PNG file. Throws std::runtime_error with the name of the
 *  file. */
void writePng(const std::filesystem::path& file, const types::Image& picture);

/** Reads a PNG file as a grey picture of 8 bits; colours become their luminance. Throws std::runtime_error with the
 *  reason, without the name of the file. */
types::Image readPng(const std::filesystem::path& file);

/** Writes a stream of pictures as numbered files, a video, or both. Makes the folders that they need. */
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
