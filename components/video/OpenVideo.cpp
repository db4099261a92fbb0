#include <opencv2/videoio.hpp>

#include "components/output/PictureFiles.hpp"

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
    const output::FileFormat* const format = output::findFileFormat(file, output::FileContent::Video);
    if (!format) return nullptr;
    const std::string_view codec = format->codec;
    cv::VideoWriter writer(file, codec == "MJPG" ? cv::CAP_OPENCV_MJPEG : cv::CAP_FFMPEG,
                           cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]), rate,
                           cv::Size(width, height));
    return writer.isOpened() ? new OpenCvVideo(std::move(writer)) : nullptr;
}

}  // namespace insonify::video
