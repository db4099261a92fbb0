#include "components/output/pictures/FanShape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace insonify::output {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double side_margin = 56, label_margin = 34, bottom_margin = 26;  // [px]

}  // namespace

FanShape FanShape::of(const types::Sonar& ping) {
    FanShape shape;
    shape.take(ping);
    shape.bin_count = ping.bin_count;
    shape.range = ping.binStart(ping.bin_count);
    return shape;
}

double FanShape::halfAngle(double right, double left, double minimum) {
    return std::min(std::max({std::abs(left), std::abs(right), minimum}), pi);
}

FanLayout::FanLayout(int width, double right, double left, double range) : range_(range), right_(right), left_(left) {
    const double half_angle = FanShape::halfAngle(right, left, pi / 180);
    const double half_width = half_angle < pi / 2 ? std::sin(half_angle) : 1;
    const double depth = half_angle < pi / 2 ? 0 : -std::cos(half_angle);
    const int even_width = width + width % 2;
    radius_ = std::floor(std::min((even_width - 2 * side_margin) / (2 * half_width), 0.9 * even_width));
    const double top = title_height + label_margin;
    const double bottom = depth > 0.5 ? label_margin : bottom_margin;
    const int height = static_cast<int>(std::ceil(top + radius_ * (1 + depth) + bottom));
    size_ = {even_width, height + height % 2};
    origin_ = {even_width / 2 - 0.5, top + radius_};
}

cv::Point2d FanLayout::pixel(double range, double bearing) const {
    const double length = radius_ * range / range_;
    return {origin_.x - length * std::sin(bearing), origin_.y - length * std::cos(bearing)};
}

bool FanLayout::reaches(const cv::Rect& area) const {
    for (int y = area.y; y < area.y + area.height; ++y)
        for (int x = area.x; x < area.x + area.width; ++x) {
            const double ahead = origin_.y - y, port = origin_.x - x, bearing = std::atan2(port, ahead);
            const bool is_within = (bearing >= right_ && bearing <= left_) || bearing + 2 * pi <= left_;
            if (is_within && std::hypot(ahead, port) < radius_ + 1) return true;
        }
    return false;
}

}  // namespace insonify::output
