#include "components/output/pictures/RangeImage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "types/geometry/Angle.hpp"

namespace insonify::output {

RangeImage::Span RangeImage::getSpan(const types::DepthMap& map) const {
    Span span{std::numeric_limits<float>::infinity(), 0};
    for (const float distance : map.distances)
        if (std::isfinite(distance)) span = {std::min(span.nearest, distance), std::max(span.farthest, distance)};
    return std::isfinite(span.nearest) ? span : Span{};
}

void RangeImage::paint(types::Image& picture) {
    static const types::DepthMap nothing;
    const types::DepthMap& map = map_ ? *map_ : nothing;
    if (const char* const diagnostic = map.diagnostic()) throw std::runtime_error(std::string("a map ") + diagnostic);
    const double rows =
        map.horizontal_size > 0 ? chart_.columns() * static_cast<double>(map.vertical_size) / map.horizontal_size : 0;
    const Span span = getSpan(map);
    cv::Mat canvas = chart_.open(picture, map.time, chart_.rowsFor(cvRound(rows), 2));
    if (!map.distances.empty()) drawCells(canvas, map, span);
    drawLabels(canvas, map, span);
}

void RangeImage::drawCells(cv::Mat& canvas, const types::DepthMap& map, const Span& span) const {
    const double depth = std::max(1e-6, static_cast<double>(span.farthest - span.nearest));
    for (int y = 0; y < cells().height; ++y)
        for (int x = 0; x < cells().width; ++x) {
            const auto row = static_cast<size_t>(y) * map.vertical_size / static_cast<size_t>(cells().height);
            const auto column = static_cast<size_t>(x) * map.horizontal_size / static_cast<size_t>(cells().width);
            const float distance = map.distances[row * map.horizontal_size + column];
            if (!std::isfinite(distance)) continue;
            const double level = 255 * static_cast<double>(span.farthest - distance) / depth;
            canvas.at<cv::Vec3b>(cells().y + y, cells().x + x) = chart_.colour(level);
        }
}

void RangeImage::drawLabels(cv::Mat& canvas, const types::DepthMap& map, const Span& span) const {
    Overlay overlay(canvas.size());
    using Anchor = Overlay::Anchor;
    Chart::labelBar(overlay, static_cast<double>(span.nearest), static_cast<double>(span.farthest));
    const auto returns = std::ranges::count_if(map.distances, [](float distance) { return std::isfinite(distance); });
    Chart::addTitle(overlay, fmt::format("{:.3f} s   {} x {} beams   {} returns, colour: range", map.time.seconds(),
                                         map.horizontal_size, map.vertical_size, returns));
    if (!map.horizontal_interval.empty()) {
        const double y = cells().br().y + 16.0;
        overlay.text(fmt::format("{:.1f}", types::degrees(map.horizontal_interval.front())), {cells().x + 2.0, y},
                     Anchor::Left, true);
        overlay.text(fmt::format("{:.1f}", types::degrees(map.horizontal_interval.back())), {cells().br().x - 8.0, y},
                     Anchor::Right, true);
    }
    overlay.finish();
    overlay.blend(canvas);
}

}  // namespace insonify::output
