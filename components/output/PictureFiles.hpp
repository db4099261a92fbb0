#pragma once
#include <filesystem>
#include <opencv2/videoio.hpp>
#include <optional>
#include <vector>

#include "components/output/FilePattern.hpp"
#include "components/output/PictureConfig.hpp"
#include "types/Image.hpp"

namespace insonify::output {

/** Writes a grey, RGB or BGR picture of 8 bits a channel as a PNG file. @throws std::runtime_error with the name of the
 * file. */
void writePng(const std::filesystem::path& file, const types::Image& picture);

/** A video file that is opened with the second picture, when the rate is known.
 *  Pictures of another size than the first are scaled to it. */
class VideoFile {
public:
    /** @param rate pictures a second; nothing: that of the first two pictures, within 1 to 60. */
    VideoFile(std::filesystem::path file, std::optional<double> rate) : file_(std::move(file)), rate_(rate) {}

    void write(const types::Image& picture);
    /** Ends the file. All of these throw std::runtime_error with the name of the file when it cannot be written. */
    void close();

private:
    void open(double rate);

    std::filesystem::path file_;
    std::optional<double> rate_;
    cv::VideoWriter writer_;
    cv::Mat first_, scaled_;
    types::Time first_time_;
};

/** The files of a stream of pictures: numbered PNG files, a video, or both. Makes the folders that they need. */
class PictureFiles {
public:
    /** Names are relative to `folder`. */
    PictureFiles(const RecordingConfig& config, const std::filesystem::path& folder);

    void write(const types::Image& picture);
    void close();

private:
    std::filesystem::path folder_;
    std::optional<FilePattern> pattern_;
    std::optional<VideoFile> video_;
    uint64_t number_ = 0;
};

}  // namespace insonify::output
