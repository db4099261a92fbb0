#include "components/output/pictures/Canvas.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <opencv2/imgproc.hpp>

#include "components/output/pictures/FanShape.hpp"
#include "components/output/pictures/Overlay.hpp"

namespace insonify::output {
namespace {

constexpr int font = cv::FONT_HERSHEY_SIMPLEX;
constexpr double font_scale = 0.45;

}  // namespace

cv::Mat openCanvas(types::Image& picture, cv::Size size, types::Time time) {
    picture.time = time;
    picture.received_time = time;
    picture.size = {static_cast<uint16_t>(size.width), static_cast<uint16_t>(size.height)};
    picture.data_depth = 8;
    picture.pixel_size = 3;
    picture.row_size = 3 * static_cast<uint32_t>(size.width);
    picture.frame_mode = types::ImageMode::Bgr;
    picture.frame_status = types::ImageStatus::Valid;
    picture.image.resize(size_t{picture.row_size} * picture.size.height);
    return cv::Mat(size, CV_8UC3, picture.image.data());
}

void Title::draw(cv::Mat& canvas, const types::Sonar& ping, const LevelScale& scale) {
    constexpr double year_2001 = 978307200;
    const double seconds = ping.time.seconds();
    column_ = 12;
    const auto out = [this] { return text_.clear(), std::back_inserter(text_); };
    if (seconds < year_2001)
        fmt::format_to(out(), "{:.3f} s", seconds);
    else
        fmt::format_to(out(), "{:%F %T} UTC", fmt::gmtime(static_cast<std::time_t>(seconds)));
    add(canvas);
    fmt::format_to(out(), "range {:.4g} m", ping.binStart(ping.bin_count));
    add(canvas);
    fmt::format_to(out(), "{} x {} bins", ping.beam_count, ping.bin_count);
    add(canvas);
    fmt::format_to(out(), "c {:.0f} m/s", ping.speed_of_sound);
    add(canvas);
    if (scale.config().scale == BinScale::Code)
        fmt::format_to(out(), "codes of {} bits", scale.config().code_bits);
    else
        fmt::format_to(out(), "white = {:.1f} dB", scale.referenceDb());
    add(canvas);
}

void Title::add(cv::Mat& canvas) {
    int baseline = 0;
    const int width = cv::getTextSize(text_, font, font_scale, 1, &baseline).width;
    if (column_ + width > canvas.cols) return;
    cv::putText(canvas, text_, {column_, FanLayout::title_height / 2 + 5}, font, font_scale, cv::Scalar(ink), 1,
                cv::LINE_AA);
    column_ += width + 28;
}

void paintBackground(cv::Mat& canvas, const Palette& palette, cv::Point bar) {
    canvas.setTo(background);
    canvas.rowRange(0, FanLayout::title_height).setTo(title_ground);
    if (!fitsColourBar(canvas.size(), bar)) return;
    for (int row = 0; row < colour_bar_size.height; ++row) {
        const int level = 255 - 255 * row / (colour_bar_size.height - 1);
        canvas(cv::Rect(bar.x, bar.y + row, colour_bar_size.width, 1))
            .setTo(cv::Scalar(palette[static_cast<size_t>(level)]));
    }
}

void sideBySide(const Captioned& left, const Captioned& right, types::Image& picture) {
    const types::ImageSize size = left.picture.size, other = right.picture.size;
    cv::Mat canvas =
        openCanvas(picture, {size.width + other.width, std::max(size.height, other.height)}, left.picture.time);
    if (size.height != other.height) canvas.setTo(background);
    int column = 0;
    for (const Captioned& half : {left, right}) {
        const cv::Mat pixels(half.picture.size.height, half.picture.size.width, CV_8UC3,
                             const_cast<uint8_t*>(half.picture.image.data()), half.picture.row_size);
        pixels.copyTo(canvas(cv::Rect(cv::Point(column, 0), pixels.size())));
        cv::putText(canvas, half.caption, {column + 12, canvas.rows - 8}, font, font_scale, cv::Scalar(ink), 1,
                    cv::LINE_AA);
        column += pixels.cols;
    }
}

}  // namespace insonify::output
