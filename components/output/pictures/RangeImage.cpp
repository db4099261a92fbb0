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

namespace {

/** Calls add(angle [deg], share of the axis) for each round angle between the first and the last of an axis of `cells`
 *  cells, whose angles are those of each cell or of the outermost two [rad]. */
void forEachTick(const std::vector<double>& angles, uint32_t cells, double min_share, const auto& add) {
    if (angles.size() < 2 || cells < 2) return;
    const double first = types::degrees(angles.front()), last = types::degrees(angles.back());
    const double low = std::min(first, last), high = std::max(first, last), step = roundStep((high - low) * min_share);
    const double cells_per_angle = (cells - 1.0) / static_cast<double>(angles.size() - 1);
    for (size_t i = 0; i + 1 < angles.size(); ++i) {
        const double here = types::degrees(angles[i]), next = types::degrees(angles[i + 1]);
        for (double tick = step * std::ceil(low / step); tick <= high && here != next; tick += step) {
            const double part = (tick - here) / (next - here);
            const bool is_last = i + 2 == angles.size();
            if (part >= 0 && (part < 1 || (is_last && part == 1)))
                add(tick, ((static_cast<double>(i) + part) * cells_per_angle + 0.5) / cells);
        }
    }
}

}  // namespace

void RangeImage::addAngles(Overlay& overlay, const types::DepthMap& map) const {
    const double from = cells().x, width = cells().width, top = cells().y, height = cells().height;
    forEachTick(map.horizontal_interval, map.horizontal_size, 64 / width, [&](double angle, double share) {
        const cv::Point2d at(from + share * width, top + height);
        overlay.line(at, at + cv::Point2d(0, 5), 235);
        overlay.text(fmt::format("{:g}", angle + 0.0), at + cv::Point2d(0, 16), Overlay::Anchor::Centre, true);
    });
    forEachTick(map.vertical_interval, map.vertical_size, 40 / height, [&](double angle, double share) {
        const cv::Point2d at(from, top + share * height);
        overlay.line(at, at - cv::Point2d(5, 0), 235);
        overlay.text(fmt::format("{:g}", 0.0 - angle), at - cv::Point2d(15, 0), Overlay::Anchor::Right, true);
    });
}

void RangeImage::drawLabels(cv::Mat& canvas, const types::DepthMap& map, const Span& span) const {
    Overlay overlay(canvas.size());
    chart_.labelBar(overlay, static_cast<double>(span.nearest), static_cast<double>(span.farthest));
    const auto returns = std::ranges::count_if(map.distances, [](float distance) { return std::isfinite(distance); });
    Chart::addTitle(overlay, {fmt::format("{:.3f} s", map.time.seconds()), "colour: range",
                              fmt::format("{} x {} beams", map.horizontal_size, map.vertical_size),
                              fmt::format("{} returns", returns)});
    addAngles(overlay, map);
    overlay.finish();
    overlay.blend(canvas);
}

}  // namespace insonify::output
