#include "components/output/SoundingMap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <opencv2/imgproc.hpp>

#include "components/output/Canvas.hpp"
#include "components/output/FanShape.hpp"

namespace insonify::output {
namespace {

constexpr int left_margin = 96, right_margin = 16, top_margin = 10, bottom_margin = 34;
constexpr double tallest = 1.5;  // of a chart [of its width]
const cv::Point colour_bar{10, FanLayout::title_height + 24};

bool isFinite(const glm::dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

template <class Use>
void forEachPoint(const std::vector<std::vector<glm::dvec3>>& clouds, Use&& use) {
    for (const std::vector<glm::dvec3>& cloud : clouds)
        for (const glm::dvec3& point : cloud)
            if (isFinite(point)) use(point);
}

}  // namespace

SoundingMap::SoundingMap(uint32_t width, ColourMap colour_map)
    : width_(static_cast<int>(width + width % 2)), palette_(paletteOf(colour_map)) {}

void SoundingMap::add(const types::PointCloudPtr& cloud) {
    if (next_ == clouds_.size()) clouds_.emplace_back();
    clouds_[next_] = cloud->points;
    next_ = (next_ + 1) % history;
    time_ = cloud->time;
}

SoundingMap::Bounds SoundingMap::bounds() const {
    Bounds bounds;
    forEachPoint(clouds_, [&](const glm::dvec3& point) {
        bounds.low = bounds.points == 0 ? point : glm::min(bounds.low, point);
        bounds.high = bounds.points == 0 ? point : glm::max(bounds.high, point);
        ++bounds.points;
    });
    return bounds;
}

void SoundingMap::fit(const Bounds& bounds) {
    const int columns = width_ - left_margin - right_margin;
    const glm::dvec3 extent = glm::max(bounds.high - bounds.low, glm::dvec3(1));
    const int rows =
        static_cast<int>(std::clamp(columns * extent.x / extent.y, colour_bar_size.height + 40.0, tallest * columns));
    chart_ = {left_margin, FanLayout::title_height + top_margin, columns, rows};
    centre_ = {(bounds.low.x + bounds.high.x) / 2, (bounds.low.y + bounds.high.y) / 2};
    pixels_per_m_ = 0.96 * std::min(columns / extent.y, rows / extent.x);
}

cv::Point SoundingMap::pixel(double x, double y) const {
    return {cvRound(chart_.x + chart_.width / 2.0 - (y - centre_.y) * pixels_per_m_),
            cvRound(chart_.y + chart_.height / 2.0 - (x - centre_.x) * pixels_per_m_)};
}

void SoundingMap::paint(types::Image& picture) {
    const Bounds all = bounds();
    fit(all);
    cv::Mat canvas = openCanvas(picture, {width_, chart_.br().y + bottom_margin}, time_);
    paintBackground(canvas, palette_, colour_bar);
    canvas(chart_).setTo(cv::Scalar(0, 0, 0));
    drawPoints(canvas, all);
    drawLabels(canvas, all);
}

void SoundingMap::drawPoints(cv::Mat& canvas, const Bounds& bounds) const {
    const double relief = std::max(bounds.high.z - bounds.low.z, 1e-6);
    // Somewhat larger than the room that a point has to itself, so that a swath has few holes and keeps its detail.
    const double room = static_cast<double>(chart_.area()) / (1.0 + static_cast<double>(bounds.points));
    const int size = std::clamp(cvRound(1.6 * std::sqrt(room)), 1, 9);
    forEachPoint(clouds_, [&](const glm::dvec3& point) {
        const auto level = static_cast<size_t>(std::clamp(255 * (point.z - bounds.low.z) / relief, 0.0, 255.0));
        const cv::Point at = pixel(point.x, point.y) - cv::Point(size / 2, size / 2);
        canvas(cv::Rect(at, cv::Size(size, size)) & chart_).setTo(cv::Scalar(palette_[level]));
    });
}

void SoundingMap::drawLabels(cv::Mat& canvas, const Bounds& bounds) const {
    Overlay overlay(canvas.size());
    using Anchor = Overlay::Anchor;
    for (int i = 0; i <= 4; ++i) {
        const double y = colour_bar.y + i / 4.0 * (colour_bar_size.height - 1);
        const double z = bounds.high.z - i / 4.0 * (bounds.high.z - bounds.low.z);
        overlay.text(fmt::format("{:.2f} m", z), {colour_bar.x + colour_bar_size.width + 5.0, y}, Anchor::Left);
    }
    const double step = roundStep(90 / pixels_per_m_);
    for (double y = step * std::ceil(bounds.low.y / step); y <= bounds.high.y; y += step)
        overlay.text(fmt::format("y {:g}", y + 0.0), {static_cast<double>(pixel(0, y).x), chart_.br().y + 16.0},
                     Anchor::Centre);
    for (double x = step * std::ceil(bounds.low.x / step); x <= bounds.high.x; x += step)
        if (const double row = pixel(x, 0).y; row > colour_bar.y + colour_bar_size.height + 20)
            overlay.text(fmt::format("x {:g}", x + 0.0), {left_margin - 8.0, row}, Anchor::Right);
    overlay.text(fmt::format("{} soundings, x north, y west [m], colour: height", bounds.points),
                 {12, FanLayout::title_height / 2.0}, Anchor::Left);
    overlay.finish();
    overlay.blend(canvas);
}

}  // namespace insonify::output
