#pragma once
#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>

namespace insonify::output {

/** A video file that is being written; it ends with the object. */
class VideoEncoder {
public:
    virtual ~VideoEncoder() = default;
    /** `picture`: 8 bits, BGR, of the size that it was opened with. */
    virtual void write(const cv::Mat& picture) = 0;
};

/** What OpenCV writes: *.avi (motion JPEG) or *.mp4 (MPEG-4). The codecs bring more than 200 libraries with them, so
 *  they are in a library of their own, libinsonify_video.so, that is loaded with the first video. Throws
 *  std::runtime_error when it is not there; null when the file cannot be written. `rate` in pictures a second. */
std::unique_ptr<VideoEncoder> openVideo(const std::filesystem::path& file, double rate, cv::Size size);

}  // namespace insonify::output
