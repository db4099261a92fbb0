#include "components/output/RangeImage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "components/output/Canvas.hpp"
#include "components/output/FanShape.hpp"
#include "components/output/Overlay.hpp"
#include "types/Angle.hpp"

namespace insonify::output {
namespace {

constexpr int left_margin = 96, right_margin = 16, top_margin = 10, bottom_margin = 34;
const cv::Point colour_bar{10, FanLayout::title_height + 24};

}  // namespace

RangeImage::RangeImage(uint32_t width, ColourMap colour_map)
    : width_(static_cast<int>(width + width % 2)), palette_(paletteOf(colour_map)) {}

RangeImage::Span RangeImage::spanOf(const types::DepthMap& map) const {
    Span span{std::numeric_limits<float>::infinity(), 0};
    for (const float distance : map.distances)
        if (std::isfinite(distance)) span = {std::min(span.nearest, distance), std::max(span.farthest, distance)};
    return std::isfinite(span.nearest) ? span : Span{};
}

void RangeImage::paint(types::Image& picture) {
    static const types::DepthMap nothing;
    const types::DepthMap& map = map_ ? *map_ : nothing;
    if (const char* const fault = map.diagnostic()) throw std::runtime_error(std::string("a map ") + fault);
    const int columns = width_ - left_margin - right_margin;
    const double rows =
        map.horizontal_size > 0 ? columns * static_cast<double>(map.vertical_size) / map.horizontal_size : 0;
    cells_ = {left_margin, FanLayout::title_height + top_margin, columns,
              std::clamp(cvRound(rows), colour_bar_size.height + 40, 2 * columns)};
    const Span span = spanOf(map);
    cv::Mat canvas = openCanvas(picture, {width_, cells_.br().y + bottom_margin}, map.time);
    paintBackground(canvas, palette_, colour_bar);
    canvas(cells_).setTo(cv::Scalar(0, 0, 0));
    if (!map.distances.empty()) drawCells(canvas, map, span);
    drawLabels(canvas, map, span);
}

void RangeImage::drawCells(cv::Mat& canvas, const types::DepthMap& map, const Span& span) const {
    const double depth = std::max(1e-6, static_cast<double>(span.farthest - span.nearest));
    for (int y = 0; y < cells_.height; ++y)
        for (int x = 0; x < cells_.width; ++x) {
            const auto row = static_cast<size_t>(y) * map.vertical_size / static_cast<size_t>(cells_.height);
            const auto column = static_cast<size_t>(x) * map.horizontal_size / static_cast<size_t>(cells_.width);
            const float distance = map.distances[row * map.horizontal_size + column];
            if (!std::isfinite(distance)) continue;
            const double level = 255 * static_cast<double>(span.farthest - distance) / depth;
            canvas.at<cv::Vec3b>(cells_.y + y, cells_.x + x) =
                palette_[static_cast<size_t>(std::clamp(level, 0.0, 255.0))];
        }
}

void RangeImage::drawLabels(cv::Mat& canvas, const types::DepthMap& map, const Span& span) const {
    Overlay overlay(canvas.size());
    using Anchor = Overlay::Anchor;
    for (int i = 0; i <= 4; ++i) {
        const double y = colour_bar.y + i / 4.0 * (colour_bar_size.height - 1);
        const float distance = span.nearest + static_cast<float>(i) / 4 * (span.farthest - span.nearest);
        overlay.text(fmt::format("{:.2f} m", distance), {colour_bar.x + colour_bar_size.width + 5.0, y}, Anchor::Left);
    }
    const auto returns = std::ranges::count_if(map.distances, [](float distance) { return std::isfinite(distance); });
    overlay.text(fmt::format("{:.3f} s   {} x {} beams   {} returns, colour: range", map.time.seconds(),
                             map.horizontal_size, map.vertical_size, returns),
                 {12, FanLayout::title_height / 2.0}, Anchor::Left);
    if (!map.horizontal_interval.empty()) {
        const double y = cells_.br().y + 16.0;
        overlay.text(fmt::format("{:.1f}", types::degrees(map.horizontal_interval.front())), {cells_.x + 2.0, y},
                     Anchor::Left, true);
        overlay.text(fmt::format("{:.1f}", types::degrees(map.horizontal_interval.back())), {cells_.br().x - 8.0, y},
                     Anchor::Right, true);
    }
    overlay.finish();
    overlay.blend(canvas);
}

}  // namespace insonify::output
