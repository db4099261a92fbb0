#include "components/output/VideoFile.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "components/loader/ComponentLibrary.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::output {
namespace {

using OpenVideo = VideoEncoder*(const char* file, double rate, int width, int height);

OpenVideo* codecs() {
    static OpenVideo* const open = loader::load("video").entry<OpenVideo>("insonify_open_video");
    return open;
}

}  // namespace

void loadCodecs() { codecs(); }

std::unique_ptr<VideoEncoder> openVideo(const std::filesystem::path& file, double rate, cv::Size size) try {
    return std::unique_ptr<VideoEncoder>(codecs()(file.c_str(), rate, size.width, size.height));
} catch (const types::ConfigError& error) {
    throw std::runtime_error("cannot write videos: " + error.diagnostics().front().text());
}

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& reason) {
    throw std::runtime_error("cannot write " + file.string() + ": " + reason);
}

cv::Mat toPixels(const types::Image& picture) {
    return cv::Mat(picture.size.height, picture.size.width, CV_8UC(static_cast<int>(picture.pixel_size)),
                   const_cast<uint8_t*>(picture.image.data()), picture.row_size);
}

}  // namespace

void VideoFile::write(const types::Image& picture) {
    const cv::Mat pixels = toPixels(picture);
    if (first_.empty()) {
        first_ = pixels.clone();
        first_time_ = picture.time;
        return;
    }
    if (!encoder_) {
        const double seconds = (picture.time - first_time_).seconds();
        open(std::clamp(seconds > 0 ? 1 / seconds : 10.0, 1.0, 60.0));
    }
    cv::resize(pixels, scaled_, first_.size());
    encoder_->write(scaled_);
}

void VideoFile::open(double rate) {
    encoder_ = openVideo(file_, rate_.value_or(rate), first_.size());
    if (!encoder_) fail(file_, "no such folder, no space left, or no encoder");
    encoder_->write(first_);
}

void VideoFile::close() {
    if (first_.empty()) return;
    if (!encoder_) open(10);
    encoder_.reset();
    std::error_code ignored;
    const auto size = std::filesystem::file_size(file_, ignored);
    if (ignored || size == 0) fail(file_, "nothing was written");
    first_.release();
}

}  // namespace insonify::output
