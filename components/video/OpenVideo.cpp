#include <opencv2/videoio.hpp>

#include "components/output/VideoFile.hpp"
#include "types/Ascii.hpp"

namespace insonify::video {
namespace {

class OpenCvVideo final : public output::VideoEncoder {
public:
    explicit OpenCvVideo(cv::VideoWriter writer) : writer_(std::move(writer)) {}
    void write(const cv::Mat& picture) override { writer_.write(picture); }

private:
    cv::VideoWriter writer_;
};

}  // namespace

/** Implements output::openVideo. The caller owns the result. */
extern "C" output::VideoEncoder* insonify_open_video(const char* file, double rate, int width, int height) {
    const bool avi = types::lowered(std::filesystem::path(file).extension().string()) == ".avi";
    const int codec = avi ? cv::VideoWriter::fourcc('M', 'J', 'P', 'G') : cv::VideoWriter::fourcc('m', 'p', '4', 'v');
    cv::VideoWriter writer(file, avi ? cv::CAP_OPENCV_MJPEG : cv::CAP_FFMPEG, codec, rate, cv::Size(width, height));
    return writer.isOpened() ? new OpenCvVideo(std::move(writer)) : nullptr;
}

}  // namespace insonify::video
