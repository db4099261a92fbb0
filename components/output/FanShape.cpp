#include "components/output/FanShape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace insonify::output {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double side_margin = 56, label_margin = 34, bottom_margin = 26;  // [px]
constexpr double single_beam_width = pi / 180;

double beamWidth(const types::Sonar& ping, const std::vector<double>& bearings) {
    if (ping.beam_width.rad > 0) return ping.beam_width.rad;
    if (bearings.size() < 2) return single_beam_width;
    return (bearings.back() - bearings.front()) / static_cast<double>(bearings.size() - 1);
}

}  // namespace

FanShape FanShape::of(const types::Sonar& ping) {
    FanShape shape;
    const auto bearingOf = [&](uint32_t beam) { return ping.bearings[beam].rad; };
    const size_t beam_count = std::min<size_t>(ping.beam_count, ping.bearings.size());
    for (uint32_t beam = 0; beam < beam_count; ++beam)
        if (!ping.bearings[beam].isUnknown()) shape.beams.push_back(beam);
    std::stable_sort(shape.beams.begin(), shape.beams.end(),
                     [&](uint32_t a, uint32_t b) { return bearingOf(a) < bearingOf(b); });
    for (const uint32_t beam : shape.beams) shape.bearings.push_back(bearingOf(beam));
    shape.bin_count = ping.bin_count;
    shape.range = ping.binStart(ping.bin_count);
    if (shape.bearings.empty()) return shape;
    const double half = beamWidth(ping, shape.bearings) / 2;
    shape.right = std::max(shape.bearings.front() - half, -pi);
    shape.left = std::min(shape.bearings.back() + half, pi);
    return shape;
}

bool FanShape::fullCircle() const { return left - right > 2 * pi - 1e-6; }

double FanShape::beamAt(double bearing) const {
    const auto after = std::upper_bound(bearings.begin(), bearings.end(), bearing);
    if (after == bearings.begin()) return 0;
    const double index = static_cast<double>(after - bearings.begin() - 1);
    if (after == bearings.end()) return index;
    const double before = *(after - 1);
    return index + (bearing - before) / (*after - before);
}

FanLayout::FanLayout(int width, double right, double left, double range) : range_(range), right_(right), left_(left) {
    const double half_angle = std::max({std::abs(left), std::abs(right), pi / 180});
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

}  // namespace insonify::output
