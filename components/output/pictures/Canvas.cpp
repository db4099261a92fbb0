#include "components/output/pictures/Canvas.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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
    constexpr int first = 12, gap = 28;
    const double seconds = ping.time.seconds();
    const auto out = [this](size_t i) { return texts_[i].clear(), std::back_inserter(texts_[i]); };
    if (seconds < year_2001)
        fmt::format_to(out(0), "{:.3f} s", seconds);
    else
        fmt::format_to(out(0), "{:%F %T} UTC", fmt::gmtime(static_cast<std::time_t>(seconds)));
    fmt::format_to(out(1), "range {:.4g} m", ping.binStart(ping.bin_count));
    fmt::format_to(out(2), "{} x {} bins", ping.beam_count, ping.bin_count);
    fmt::format_to(out(3), "c {:.0f} m/s", ping.speed_of_sound);
    if (scale.config().scale == BinScale::Code)
        fmt::format_to(out(4), "codes of {} bits", scale.config().code_bits);
    else
        fmt::format_to(out(4), "white = {:.1f} dB", scale.referenceDb());
    int room = canvas.cols - first, baseline = 0;
    std::array<int, 5> widths{};
    for (const size_t i : {0, 4, 1, 2, 3}) {  // the most important ones first
        const int width = cv::getTextSize(texts_[i], font, font_scale, 1, &baseline).width;
        if (width > room) break;
        widths[i] = width;
        room -= width + gap;
    }
    int column = first;
    for (size_t i = 0; i < texts_.size(); ++i) {
        if (widths[i] == 0) continue;
        cv::putText(canvas, texts_[i], {column, FanLayout::title_height / 2 + 5}, font, font_scale, cv::Scalar(ink), 1,
                    cv::LINE_AA);
        column += widths[i] + gap;
    }
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
    constexpr int strip = 24;
    const int height =
        std::max(size.height, other.height) + (left.caption.empty() && right.caption.empty() ? 0 : strip);
    cv::Mat canvas = openCanvas(picture, {size.width + other.width, height}, left.picture.time);
    canvas.setTo(background);
    int column = 0;
    for (const Captioned& half : {left, right}) {
        const cv::Mat pixels(half.picture.size.height, half.picture.size.width, CV_8UC3,
                             const_cast<uint8_t*>(half.picture.image.data()), half.picture.row_size);
        pixels.copyTo(canvas(cv::Rect(cv::Point(column, 0), pixels.size())));
        putLabel(canvas, half.caption, {column + 12, canvas.rows - 8}, pixels.cols - 24);
        column += pixels.cols;
    }
}

Chart::Chart(uint32_t width, ColourMap colour_map)
    : width_(static_cast<int>(width + width % 2)), palette_(getPalette(colour_map)) {}

int Chart::rowsFor(double rows, double tallest) const {
    return static_cast<int>(std::clamp(rows, colour_bar_size.height + 40.0, tallest * columns()));
}

cv::Mat Chart::open(types::Image& picture, types::Time time, int rows) {
    area_ = {left_margin, FanLayout::title_height + top_margin, columns(), rows};
    cv::Mat canvas = openCanvas(picture, {width_, area_.br().y + bottom_margin}, time);
    paintBackground(canvas, palette_, bar());
    canvas(area_).setTo(cv::Scalar(0, 0, 0));
    return canvas;
}

const cv::Vec3b& Chart::colour(double level) const {
    return palette_[static_cast<size_t>(std::clamp(level, 0.0, 255.0))];
}

void Chart::labelBar(Overlay& overlay, double top, double bottom) const {
    const double low = std::min(top, bottom), span = std::abs(bottom - top), x = bar().x + colour_bar_size.width;
    const double step = roundStep(std::max({span / 4.5, 1e-9 * std::abs(low), 1e-6}));
    const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
    overlay.take(cv::Rect(bar(), colour_bar_size));
    for (double value = step * std::ceil(low / step - 1e-9); value <= low + span + 1e-9 * step; value += step) {
        const double share = span > 0 ? (value - top) / (bottom - top) : 0;
        const double y = bar().y + share * (colour_bar_size.height - 1);
        overlay.line({x + 1, y}, {x + 4, y}, 235);
        overlay.text(fmt::format("{:.{}f} m", value + 0.0, decimals), {x + 8, y}, Overlay::Anchor::Left);
    }
}

void Chart::addTitle(Overlay& overlay, const std::vector<std::string>& parts) {
    std::string title, longer;
    for (const std::string& part : parts) {
        longer += (longer.empty() ? "" : "   ") + part;
        if (measureWidth(longer) > overlay.size().width - 24) break;
        title = longer;
    }
    overlay.text(title, {12, FanLayout::title_height / 2.0}, Overlay::Anchor::Left);
}

}  // namespace insonify::output
