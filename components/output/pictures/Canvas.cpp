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

struct Anchor {
    int level;
    cv::Vec3d bgr;
};

/** From black water over brown and orange to white, as in viewers of imaging sonars. */
const Anchor amber[] = {{0, {6, 5, 6}},        {40, {6, 22, 44}},      {96, {8, 62, 120}},    {150, {14, 118, 204}},
                        {200, {48, 180, 246}}, {235, {140, 226, 255}}, {255, {236, 252, 255}}};

const Anchor copper[] = {{0, {0, 0, 0}}, {203, {101, 159, 255}}, {255, {127, 199, 255}}};
const Anchor gray[] = {{0, {0, 0, 0}}, {255, {255, 255, 255}}};

Palette interpolated(const Anchor* anchor) {
    Palette palette;
    for (int level = 0; level < 256; ++level) {
        if (level > anchor[1].level) ++anchor;
        const double share = double(level - anchor[0].level) / (anchor[1].level - anchor[0].level);
        palette[static_cast<size_t>(level)] = cv::Vec3b(anchor[0].bgr * (1 - share) + anchor[1].bgr * share);
    }
    return palette;
}

Palette fromOpenCv(int map) {
    cv::Mat levels(1, 256, CV_8U), colours;
    for (int level = 0; level < 256; ++level) levels.at<uint8_t>(level) = static_cast<uint8_t>(level);
    cv::applyColorMap(levels, colours, map);
    Palette palette;
    std::copy_n(colours.ptr<cv::Vec3b>(), palette.size(), palette.begin());
    return palette;
}

}  // namespace

Palette getPalette(ColourMap map) {
    switch (map) {
        case ColourMap::Amber: return interpolated(amber);
        case ColourMap::Copper: return interpolated(copper);
        case ColourMap::Turbo: return fromOpenCv(cv::COLORMAP_TURBO);
        case ColourMap::Viridis: return fromOpenCv(cv::COLORMAP_VIRIDIS);
        case ColourMap::Inferno: return fromOpenCv(cv::COLORMAP_INFERNO);
        case ColourMap::Gray: break;
    }
    return interpolated(gray);
}

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

const cv::Point Chart::colour_bar{10, FanLayout::title_height + 24};

Chart::Chart(uint32_t width, ColourMap colour_map)
    : width_(static_cast<int>(width + width % 2)), palette_(getPalette(colour_map)) {}

int Chart::rowsFor(double rows, double tallest) const {
    return static_cast<int>(std::clamp(rows, colour_bar_size.height + 40.0, tallest * columns()));
}

cv::Mat Chart::open(types::Image& picture, types::Time time, int rows) {
    area_ = {left_margin, FanLayout::title_height + top_margin, columns(), rows};
    cv::Mat canvas = openCanvas(picture, {width_, area_.br().y + bottom_margin}, time);
    paintBackground(canvas, palette_, colour_bar);
    canvas(area_).setTo(cv::Scalar(0, 0, 0));
    return canvas;
}

const cv::Vec3b& Chart::colour(double level) const {
    return palette_[static_cast<size_t>(std::clamp(level, 0.0, 255.0))];
}

void Chart::labelBar(Overlay& overlay, double top, double bottom) {
    for (int i = 0; i <= 4; ++i) {
        const double y = colour_bar.y + i / 4.0 * (colour_bar_size.height - 1);
        overlay.text(fmt::format("{:.2f} m", top + i / 4.0 * (bottom - top)),
                     {colour_bar.x + colour_bar_size.width + 5.0, y}, Overlay::Anchor::Left);
    }
}

void Chart::addTitle(Overlay& overlay, const std::string& text) {
    overlay.text(text, {12, FanLayout::title_height / 2.0}, Overlay::Anchor::Left);
}

}  // namespace insonify::output
