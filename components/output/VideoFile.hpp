#pragma once
#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "types/samples/Image.hpp"

namespace insonify::output {

/** Writes a video file, which ends with the object. */
class VideoEncoder {
public:
    virtual ~VideoEncoder() = default;
    /** @param picture 8 bits, BGR, of the size of the video */
    virtual void write(const cv::Mat& picture) = 0;
};

/** Loads the component library video before the first video. Throws types::ConfigError if it is absent or cannot be
 *  loaded. */
void loadCodecs();

/** Opens a video that OpenCV writes: *.avi (motion JPEG) or *.mp4 (MPEG-4). The codecs need more than 200 libraries, so
 *  they are in the component library video, which is loaded for the first video. Throws std::runtime_error if it cannot
 *  be loaded; returns null if the file cannot be written. `rate` in pictures a second. */
std::unique_ptr<VideoEncoder> openVideo(const std::filesystem::path& file, double rate, cv::Size size);

/** Writes a video file, opened with the second picture, when the rate is known. Pictures of another size are scaled to
 *  that of the first. */
class VideoFile {
public:
    /** @param rate pictures a second; none: that of the first two pictures, within 1 to 60 */
    VideoFile(std::filesystem::path file, std::optional<double> rate) : file_(std::move(file)), rate_(rate) {}

    void write(const types::Image& picture);
    /** Ends the file. All functions throw std::runtime_error with the name of the file if it cannot be written. */
    void close();

private:
    void open(double rate);

    std::filesystem::path file_;
    std::optional<double> rate_;
    std::unique_ptr<VideoEncoder> encoder_;
    cv::Mat first_, scaled_;
    types::Time first_time_;
};

}  // namespace insonify::output
