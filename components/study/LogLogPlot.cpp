#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "components/study/Plot.hpp"

namespace insonify::study {
namespace {

constexpr double width = 720, height = 460, left = 80, right = 190, top = 40, bottom = 60;

/** One logarithmic axis: whole decades of values onto a stretch of the image. */
class Axis {
public:
    Axis(double from, double to) : from_(from), to_(to) {}
    void include(double value) {
        low_ = std::min(low_, std::floor(std::log10(value) + 1e-9));
        high_ = std::max(high_, std::ceil(std::log10(value) - 1e-9));
    }
    double at(double value) const {
        if (empty()) return from_;
        const double span = std::max(1.0, high_ - low_);
        return from_ + (std::log10(value) - low_) / span * (to_ - from_);
    }
    int first() const { return empty() ? 0 : static_cast<int>(low_); }
    int last() const { return empty() ? 0 : static_cast<int>(std::max(high_, low_ + 1)); }

private:
    bool empty() const { return !(low_ <= high_); }

    double from_, to_;
    double low_ = std::numeric_limits<double>::infinity(), high_ = -std::numeric_limits<double>::infinity();
};

using Out = std::back_insert_iterator<std::string>;

void drawGrid(Out out, const Axis& x, const Axis& y) {
    const auto line = [&](double x1, double y1, double x2, double y2, bool decade) {
        fmt::format_to(out, "<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke='{}'/>\n", x1, y1, x2, y2,
                       decade ? "#b8c4cc" : "#e6ecef");
    };
    for (int decade = x.first(); decade <= x.last(); ++decade)
        for (int step = 1; step < (decade < x.last() ? 10 : 2); ++step)
            line(x.at(step * std::pow(10, decade)), top, x.at(step * std::pow(10, decade)), height - bottom, step == 1);
    for (int decade = y.first(); decade <= y.last(); ++decade)
        for (int step = 1; step < (decade < y.last() ? 10 : 2); ++step)
            line(left, y.at(step * std::pow(10, decade)), width - right, y.at(step * std::pow(10, decade)), step == 1);
    for (int decade = x.first(); decade <= x.last(); ++decade)
        fmt::format_to(out, "<text x='{:.1f}' y='{}' text-anchor='middle'>{:g}</text>\n", x.at(std::pow(10, decade)),
                       height - bottom + 18, std::pow(10, decade));
    for (int decade = y.first(); decade <= y.last(); ++decade)
        fmt::format_to(out, "<text x='{}' y='{:.1f}' text-anchor='end'>{:g}</text>\n", left - 8,
                       y.at(std::pow(10, decade)) + 4, std::pow(10, decade));
}

void drawCurve(Out out, const Axis& x, const Axis& y, const Curve& curve) {
    fmt::format_to(out, "<polyline fill='none' stroke='{}' stroke-width='2' points='", curve.colour);
    for (const auto& p : curve.points) fmt::format_to(out, "{:.1f},{:.1f} ", x.at(p.x), y.at(p.y));
    fmt::format_to(out, "'/>\n");
    for (const auto& p : curve.points) {
        fmt::format_to(out, "<circle cx='{:.1f}' cy='{:.1f}' r='3.5' fill='{}'/>\n", x.at(p.x), y.at(p.y),
                       curve.colour);
        if (p.marked)
            fmt::format_to(out, "<circle cx='{:.1f}' cy='{:.1f}' r='7' fill='none' stroke='{}'/>\n", x.at(p.x),
                           y.at(p.y), curve.colour);
    }
}

void drawLevel(Out out, double y, const std::string& name) {
    fmt::format_to(out, "<line x1='{0}' y1='{2:.1f}' x2='{1}' y2='{2:.1f}' stroke='#667' stroke-dasharray='6 4'/>\n",
                   left, width - right, y);
    fmt::format_to(out, "<text x='{}' y='{:.1f}' fill='#667'>{}</text>\n", left + 6, y - 5, name);
}

void drawLegend(Out out, const std::vector<Curve>& curves) {
    double at = top + 10;
    for (const Curve& curve : curves) {
        fmt::format_to(out, "<line x1='{0}' y1='{1}' x2='{2}' y2='{1}' stroke='{3}' stroke-width='3'/>\n",
                       width - right + 12, at, width - right + 32, curve.colour);
        fmt::format_to(out, "<text x='{}' y='{}'>{}</text>\n", width - right + 38, at + 4, curve.name);
        at += 20;
    }
    fmt::format_to(out, "<text x='{}' y='{}' fill='#667'>ringed: nothing else is</text>\n", width - right + 12,
                   at + 10);
    fmt::format_to(out, "<text x='{}' y='{}' fill='#667'>both faster and better</text>\n", width - right + 12, at + 26);
}

}  // namespace

std::string logLogPlot(const std::string& title, const std::string& x_label, const std::string& y_label,
                       const std::vector<Curve>& curves, const std::vector<Level>& levels) {
    Axis x(left, width - right), y(height - bottom, top);
    for (const Curve& curve : curves)
        for (const auto& point : curve.points) x.include(point.x), y.include(point.y);
    for (const Level& level : levels) y.include(level.y);
    std::string svg;
    Out out(svg);
    fmt::format_to(out,
                   "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0} {1}' width='{0}' height='{1}' "
                   "font-family='sans-serif' font-size='12'>\n",
                   width, height);
    fmt::format_to(out,
                   "<rect width='100%' height='100%' fill='white'/>\n<text x='{}' y='24' font-size='15'>{}</text>\n",
                   left, title);
    drawGrid(out, x, y);
    for (const Level& level : levels) drawLevel(out, y.at(level.y), level.name);
    for (const Curve& curve : curves) drawCurve(out, x, y, curve);
    drawLegend(out, curves);
    fmt::format_to(out, "<text x='{}' y='{}' text-anchor='middle'>{}</text>\n", (left + width - right) / 2, height - 18,
                   x_label);
    fmt::format_to(out, "<text transform='translate(20 {}) rotate(-90)' text-anchor='middle'>{}</text>\n</svg>\n",
                   (top + height - bottom) / 2, y_label);
    return svg;
}

}  // namespace insonify::study
