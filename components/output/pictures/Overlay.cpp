#include "components/output/pictures/Overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "components/output/pictures/Canvas.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::output {
namespace {

constexpr int label_font = cv::FONT_HERSHEY_SIMPLEX;
constexpr double label_scale = 0.42;
constexpr int full = 235, ring_opacity = 74, spoke_opacity = 44, outline_opacity = 140;
constexpr int label_bits = 4;

cv::Point subPixel(cv::Point2d at) { return {cvRound(at.x * (1 << label_bits)), cvRound(at.y * (1 << label_bits))}; }

constexpr int above_bar = 8, below_bar = 13, bar_to_label = 8;  ///< From the bar to its labels or their edge [px].

/** A label beside the colour bar, at a share of its height below the top. */
struct BarLabel {
    double share_below;
    std::string text;
};

std::vector<BarLabel> makeBarLabels(const DisplayConfig& display) {
    const bool codes = display.scale == BinScale::Code;
    const double span = codes ? display.maxCode() : display.dynamic_range_db, step = roundStep(span / 4.5);
    std::vector<BarLabel> labels{{0, codes ? fmt::format("{:.0f}", span) : "0 dB"}};
    if (codes)
        for (double code = 0; code <= span - step / 2; code += step)
            labels.push_back({1 - code / span, fmt::format("{:.0f}", code)});
    else
        for (double below = step; below < span * (1 + 1e-9); below += step)
            labels.push_back({below / span, fmt::format("{:g}", -below)});
    return labels;
}

/** Returns the degrees between spokes, so that their labels fit on the outer arc. */
double spokeStep(double radius) {
    for (const double step : {1, 2, 5, 10, 15, 30, 45})
        if (types::radians(step) * radius > 56) return step;
    return 90;
}

void addRings(Overlay& overlay, const FanLayout& layout) {
    const double metres_per_pixel = layout.range() / layout.radius();
    const double step = roundStep(64 * metres_per_pixel, layout.range());
    const bool half_plane = layout.left() < std::numbers::pi / 2 && layout.right() > -std::numbers::pi / 2;
    for (double range = step; range < layout.range() * (1 + 1e-9); range += step) {
        const double radius = range / metres_per_pixel;
        if (radius < layout.radius() - 1)
            overlay.arc(layout.origin(), radius, layout.right(), layout.left(), ring_opacity);
        // Next to the starboard edge of a fan within the half plane ahead, else ahead, or in the middle of a fan that
        // is not ahead.
        const bool ahead = layout.right() <= 0 && layout.left() >= 0;
        const double bearing = half_plane ? layout.right() : ahead ? 0 : (layout.right() + layout.left()) / 2;
        const cv::Point2d at = layout.pixel(range, bearing);
        const cv::Point2d aside = half_plane ? cv::Point2d(8, 9 * std::sin(-bearing)) : cv::Point2d(5, 9);
        if (half_plane || radius < layout.radius() - 12)
            overlay.text(fmt::format("{:g} m", range), at + aside, Overlay::Anchor::Left, false, !half_plane);
    }
}

void addSpokes(Overlay& overlay, const FanLayout& layout) {
    const double step = spokeStep(layout.radius());
    const double left = types::degrees(layout.left()), right = types::degrees(layout.right());
    for (double degrees = std::ceil(right / step - 1e-6) * step; degrees < left + 1e-6; degrees += step) {
        if (degrees + 360 < left + 1e-6) continue;  // drawn at the port edge
        const double bearing = types::radians(degrees);
        overlay.line(layout.pixel(layout.range() * 0.04, bearing), layout.pixel(layout.range(), bearing),
                     spoke_opacity);
        const cv::Point2d outward(-std::sin(bearing), -std::cos(bearing));
        const cv::Point2d end = layout.pixel(layout.range(), bearing);
        overlay.line(end, end + 5 * outward, full);
        const double turn = degrees > 180 + 1e-6 ? -360 : degrees < -180 + 1e-6 ? 360 : 0, shown = degrees + turn;
        const std::string text = fmt::format("{:g}", shown + 0.0);
        const double away = std::abs(outward.x) * (measureWidth(text) / 2.0 + 6) + std::abs(outward.y) * 10 + 4;
        overlay.text(text, end + away * outward, Overlay::Anchor::Centre, true);
    }
}

void addOutline(Overlay& overlay, const FanLayout& layout) {
    overlay.arc(layout.origin(), layout.radius(), layout.right(), layout.left(), outline_opacity);
    if (layout.left() - layout.right() > 2 * std::numbers::pi - 1e-6) return;
    for (const double edge : {layout.left(), layout.right()})
        overlay.line(layout.origin(), layout.pixel(layout.range(), edge), outline_opacity);
}

}  // namespace

void Overlay::line(cv::Point2d from, cv::Point2d to, int opacity) {
    cv::line(cover_, subPixel(from), subPixel(to), opacity, 1, cv::LINE_AA, label_bits);
}

void Overlay::arc(cv::Point2d centre, double radius, double right, double left, int opacity) {
    const int steps = std::max(8, static_cast<int>(radius * (left - right) / 4));
    std::vector<cv::Point> points;
    for (int i = 0; i <= steps; ++i) {
        const double bearing = right + (left - right) * i / steps;
        points.push_back(subPixel({centre.x - radius * std::sin(bearing), centre.y - radius * std::cos(bearing)}));
    }
    cv::polylines(cover_, points, false, opacity, 1, cv::LINE_AA, label_bits);
}

void Overlay::text(const std::string& text, cv::Point2d at, Anchor anchor, bool degrees, bool on_echoes) {
    constexpr int ring_width = 6, margin = 2;
    int baseline = 0;
    const cv::Size size = cv::getTextSize(text, label_font, label_scale, 1, &baseline);
    const double back = anchor == Anchor::Left ? 0 : anchor == Anchor::Centre ? size.width / 2.0 : size.width;
    cv::Point start(cvRound(at.x - back), cvRound(at.y + size.height / 2.0));
    cv::Rect box(start.x - margin, start.y - size.height - margin, size.width + 2 * margin + (degrees ? ring_width : 0),
                 size.height + baseline + 2 * margin);
    const cv::Point within(std::max(0, std::min(box.x, size_.width - box.width)),
                           std::max(0, std::min(box.y, size_.height - box.height)));
    const cv::Point moved = within - box.tl();
    box += moved, start += moved;
    const auto touches = [&box](const cv::Rect& area) { return (box & area).area() > 0; };
    if (std::ranges::any_of(taken_, touches) || box.width > size_.width) return;
    take(box);
    if (on_echoes || moved != cv::Point()) plates_.push_back(box);
    cv::putText(cover_, text, start, label_font, label_scale, full, 1, cv::LINE_AA);
    if (degrees)
        cv::circle(cover_, subPixel({start.x + size.width + 2.0, start.y - size.height + 1.0}), 2 << label_bits, full,
                   1, cv::LINE_AA, label_bits);
}

void Overlay::finish() {
    for (int row = 0; row < cover_.rows; ++row)
        for (int column = 0; column < cover_.cols; ++column)
            if (const uint8_t opacity = cover_.at<uint8_t>(row, column)) touched_.push_back({row, column, opacity});
    cover_.release();
}

void Overlay::blend(cv::Mat& picture) const {
    for (const cv::Rect& plate : plates_)
        for (int row = plate.y; row < plate.br().y; ++row)
            for (int column = plate.x; column < plate.br().x; ++column) picture.at<cv::Vec3b>(row, column) /= 4;
    for (const Touch& touch : touched_) {
        cv::Vec3b& pixel = picture.at<cv::Vec3b>(touch.row, touch.column);
        for (int channel = 0; channel < 3; ++channel)
            pixel[channel] =
                static_cast<uint8_t>(pixel[channel] + (ink[channel] - pixel[channel]) * touch.opacity / 255);
    }
}

Overlay fanOverlay(const FanLayout& layout, cv::Point bar, const DisplayConfig& display) {
    Overlay overlay(layout.size());
    overlay.take({0, 0, layout.size().width, FanLayout::title_height});
    addColourBar(overlay, bar, display);
    addRings(overlay, layout);
    addSpokes(overlay, layout);
    addOutline(overlay, layout);
    overlay.finish();
    return overlay;
}

cv::Rect labelledBar(cv::Point at, const DisplayConfig& display) {
    int widest = 0;
    for (const BarLabel& label : makeBarLabels(display)) widest = std::max(widest, measureWidth(label.text));
    return {at.x, at.y - above_bar, colour_bar_size.width + bar_to_label + widest + 2,
            colour_bar_size.height + above_bar + below_bar};
}

cv::Point placeOfBar(const FanLayout& layout, const DisplayConfig& display) {
    const cv::Size size = layout.size(), bar = labelledBar({}, display).size();
    const int left = 14, right = size.width - bar.width - 6, top = FanLayout::title_height + 18;
    const int bottom = size.height - bar.height + above_bar - 6;
    for (const cv::Point at : {cv::Point(left, top), {left, bottom}, {right, top}, {right, bottom}})
        if (at.y >= top && at.x >= left && fitsColourBar(size, at) && !layout.reaches(labelledBar(at, display)))
            return at;
    return {-1000, -1000};
}

bool fitsColourBar(cv::Size picture, cv::Point at) {
    const cv::Rect bar(at, colour_bar_size);
    return (bar & cv::Rect({}, picture)) == bar;
}

void addColourBar(Overlay& overlay, cv::Point at, const DisplayConfig& display) {
    if (!fitsColourBar(overlay.size(), at)) return;
    overlay.take(cv::Rect(at, colour_bar_size));
    for (const BarLabel& label : makeBarLabels(display)) {
        const double x = at.x + colour_bar_size.width, y = at.y + label.share_below * (colour_bar_size.height - 1);
        overlay.line({x + 1, y}, {x + 4, y}, full);
        overlay.text(label.text, {x + bar_to_label, y}, Overlay::Anchor::Left);
    }
}

double roundStep(double minimum) {
    const double power = std::pow(10, std::floor(std::log10(minimum)));
    for (const double factor : {1, 2, 5})
        if (factor * power >= minimum * (1 - 1e-9)) return factor * power;
    return 10 * power;
}

double roundStep(double minimum, double end) { return std::min(roundStep(minimum), roundStep(0.4 * end)); }

int measureWidth(const std::string& text) {
    int baseline = 0;
    return cv::getTextSize(text, label_font, label_scale, 1, &baseline).width;
}

void putLabel(cv::Mat& picture, const std::string& text, cv::Point at, int width) {
    const auto put = [&](const std::string& part) {
        cv::putText(picture, part, at, label_font, label_scale, cv::Scalar(ink), 1, cv::LINE_AA);
    };
    if (measureWidth(text) <= width) return put(text);
    std::string part = text + "..";
    while (part.size() > 2 && measureWidth(part) > width) part.erase(part.size() - 3, 1);
    put(part);
}

}  // namespace insonify::output
