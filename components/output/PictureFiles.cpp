#include "components/output/PictureFiles.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace insonify::output {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& reason) {
    throw std::runtime_error("cannot write " + file.string() + ": " + reason);
}

cv::Mat pixelsOf(const types::Image& picture) {
    return cv::Mat(picture.size.height, picture.size.width, CV_8UC(static_cast<int>(picture.pixel_size)),
                   const_cast<uint8_t*>(picture.image.data()), picture.row_size);
}

/** Grey or BGR, as OpenCV has it; empty for a mode that is neither, nor RGB. */
cv::Mat shownPixels(const types::Image& picture) {
    const bool grey = picture.frame_mode == types::ImageMode::Grayscale;
    const bool rgb = picture.frame_mode == types::ImageMode::Rgb;
    const bool known = grey || rgb || picture.frame_mode == types::ImageMode::Bgr;
    if (!known || picture.pixel_size != (grey ? 1 : 3) || !picture.holdsPixels()) return {};
    if (!rgb) return pixelsOf(picture);
    cv::Mat turned;
    cv::cvtColor(pixelsOf(picture), turned, cv::COLOR_RGB2BGR);
    return turned;
}

bool isKnownVideo(const std::string& name) {
    const std::string extension = std::filesystem::path(name).extension().string();
    return extension == ".avi" || extension == ".mp4";
}

}  // namespace

void RecordingConfig::check(types::Problems& problems) const {
    if (file && !FilePattern::parse(*file))
        problems.push_back({"file", "is '" + *file + "'; it must have one number and end in .png, as in fan_%06d.png"});
    if (video && !isKnownVideo(*video))
        problems.push_back({"video", "is '" + *video + "'; it must end in .avi or .mp4"});
}

void writePng(const std::filesystem::path& file, const types::Image& picture) {
    const cv::Mat pixels = shownPixels(picture);
    if (pixels.empty()) fail(file, "the picture is empty, or neither grey, RGB nor BGR of 8 bits a channel");
    std::vector<uint8_t> encoded;
    cv::imencode(".png", pixels, encoded, {cv::IMWRITE_PNG_COMPRESSION, 2});
    errno = 0;
    std::ofstream stream(file, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(encoded.data()), static_cast<std::streamsize>(encoded.size()));
    stream.close();
    if (!stream) fail(file, std::strerror(errno));
}

void VideoFile::write(const types::Image& picture) {
    const cv::Mat pixels = pixelsOf(picture);
    if (first_.empty()) {
        first_ = pixels.clone();
        first_time_ = picture.time;
        return;
    }
    if (!writer_.isOpened()) {
        const double seconds = (picture.time - first_time_).seconds();
        open(std::clamp(seconds > 0 ? 1 / seconds : 10.0, 1.0, 60.0));
    }
    cv::resize(pixels, scaled_, first_.size());
    writer_.write(scaled_);
}

void VideoFile::open(double rate) {
    const bool avi = file_.extension() == ".avi";
    const int codec = avi ? cv::VideoWriter::fourcc('M', 'J', 'P', 'G') : cv::VideoWriter::fourcc('m', 'p', '4', 'v');
    if (!writer_.open(file_.string(), avi ? cv::CAP_OPENCV_MJPEG : cv::CAP_FFMPEG, codec, rate_.value_or(rate),
                      first_.size()))
        fail(file_, "no such folder, no room, or no encoder");
    writer_.write(first_);
}

void VideoFile::close() {
    if (first_.empty()) return;
    if (!writer_.isOpened()) open(10);
    writer_.release();
    std::error_code ignored;
    const auto size = std::filesystem::file_size(file_, ignored);
    if (ignored || size == 0) fail(file_, "nothing was written");
    first_.release();
}

PictureFiles::PictureFiles(const RecordingConfig& config, const std::filesystem::path& folder) : folder_(folder) {
    if (config.file) {
        pattern_ = FilePattern::parse(*config.file);
        std::filesystem::create_directories((folder / *config.file).parent_path());
    }
    if (config.video) {
        video_.emplace(folder / *config.video, config.video_rate);
        std::filesystem::create_directories((folder / *config.video).parent_path());
    }
}

void PictureFiles::write(const types::Image& picture) {
    if (pattern_) writePng(folder_ / pattern_->name(number_++), picture);
    if (video_) video_->write(picture);
}

void PictureFiles::close() {
    if (video_) video_->close();
}

}  // namespace insonify::output
