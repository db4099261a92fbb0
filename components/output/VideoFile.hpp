#pragma once
#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "components/output/VideoEncoder.hpp"
#include "types/Image.hpp"

namespace insonify::output {

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
