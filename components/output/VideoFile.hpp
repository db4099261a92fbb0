#pragma once
#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "types/Image.hpp"

namespace insonify::output {

/** A video file that is being written; it ends with the object. */
class VideoEncoder {
public:
    virtual ~VideoEncoder() = default;
    /** `picture`: 8 bits, BGR, of the size that it was opened with. */
    virtual void write(const cv::Mat& picture) = 0;
};

/** Loads the component library video now rather than with the first video. Throws types::ConfigError when it is absent
 *  or cannot be loaded. */
void loadCodecs();

/** What OpenCV writes: *.avi (motion JPEG) or *.mp4 (MPEG-4). The codecs bring more than 200 libraries with them, so
 *  they are in the component library video, which is loaded with the first one. Throws
 *  std::runtime_error when it cannot be loaded; null when the file cannot be written. `rate` in pictures a second. */
std::unique_ptr<VideoEncoder> openVideo(const std::filesystem::path& file, double rate, cv::Size size);

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
    std::unique_ptr<VideoEncoder> encoder_;
    cv::Mat first_, scaled_;
    types::Time first_time_;
};

}  // namespace insonify::output
