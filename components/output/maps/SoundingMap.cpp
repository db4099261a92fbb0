#include "components/output/maps/SoundingMap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace insonify::output {
namespace {

constexpr double tallest = 1.5;  // max height of a chart [of its width]

bool isFinite(const glm::dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

void forEachPoint(const std::vector<std::vector<glm::dvec3>>& clouds, auto&& use) {
    for (const std::vector<glm::dvec3>& cloud : clouds)
        for (const glm::dvec3& point : cloud)
            if (isFinite(point)) use(point);
}

}  // namespace

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

int SoundingMap::fit(const Bounds& bounds) {
    const int columns = chart_.columns();
    const glm::dvec3 extent = glm::max(bounds.high - bounds.low, glm::dvec3(1));
    const int rows = chart_.rowsFor(columns * extent.x / extent.y, tallest);
    centre_ = {(bounds.low.x + bounds.high.x) / 2, (bounds.low.y + bounds.high.y) / 2};
    pixels_per_m_ = 0.96 * std::min(columns / extent.y, rows / extent.x);
    return rows;
}

cv::Point SoundingMap::pixel(double x, double y) const {
    const cv::Rect& area = chart_.area();
    return {cvRound(area.x + area.width / 2.0 - (y - centre_.y) * pixels_per_m_),
            cvRound(area.y + area.height / 2.0 - (x - centre_.x) * pixels_per_m_)};
}

void SoundingMap::paint(types::Image& picture) {
    const Bounds all = bounds();
    cv::Mat canvas = chart_.open(picture, time_, fit(all));
    drawPoints(canvas, all);
    drawLabels(canvas, all);
}

void SoundingMap::drawPoints(cv::Mat& canvas, const Bounds& bounds) const {
    const double relief = std::max(bounds.high.z - bounds.low.z, 1e-6);
    // Points are slightly larger than the area per point, so that a swath has few holes and keeps its detail.
    const double room = static_cast<double>(chart_.area().area()) / (1.0 + static_cast<double>(bounds.points));
    const int size = std::clamp(cvRound(1.6 * std::sqrt(room)), 1, 9);
    forEachPoint(clouds_, [&](const glm::dvec3& point) {
        const double level = 255 * (point.z - bounds.low.z) / relief;
        const cv::Point at = pixel(point.x, point.y) - cv::Point(size / 2, size / 2);
        canvas(cv::Rect(at, cv::Size(size, size)) & chart_.area()).setTo(cv::Scalar(chart_.colour(level)));
    });
}

void SoundingMap::drawLabels(cv::Mat& canvas, const Bounds& bounds) const {
    Overlay overlay(canvas.size());
    using Anchor = Overlay::Anchor;
    chart_.labelBar(overlay, bounds.high.z, bounds.low.z);
    const double step = roundStep(90 / pixels_per_m_);
    for (double y = step * std::ceil(bounds.low.y / step); y <= bounds.high.y; y += step)
        overlay.text(fmt::format("y {:.12g}", y + 0.0),
                     {static_cast<double>(pixel(0, y).x), chart_.area().br().y + 16.0}, Anchor::Centre);
    for (double x = step * std::ceil(bounds.low.x / step); x <= bounds.high.x; x += step)
        overlay.text(fmt::format("x {:.12g}", x + 0.0), {Chart::left_margin - 8.0, static_cast<double>(pixel(x, 0).y)},
                     Anchor::Right);
    std::vector<std::string> title{"x north, y west [m]", "colour: height", fmt::format("{} soundings", bounds.points)};
    if (datum_)
        title.insert(title.begin() + 1,
                     fmt::format("from {:.7f} N {:.7f} E", datum_->latitude_deg, datum_->longitude_deg));
    Chart::addTitle(overlay, title);
    overlay.finish();
    overlay.blend(canvas);
}

}  // namespace insonify::output
