#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "components/study/Plot.hpp"

namespace insonify::study {
namespace {

constexpr double width = 760, height = 320, left = 70, right = 150, top = 36, bottom = 50;
using Out = std::back_insert_iterator<std::string>;

/** Draws one diagram, whose upper left corner is the origin. */
class Drawing {
public:
    Drawing(Out out, const Diagram& diagram) : out_(out), diagram_(diagram) {}

    void draw() {
        text((left + width - right) / 2, top - 14, "middle", diagram_.title);
        for (double x = diagram_.x_min; x <= diagram_.x_max * (1 + 1e-9); x += diagram_.x_step) {
            line(atX(x), top, atX(x), height - bottom);
            text(atX(x), height - bottom + 16, "middle", fmt::format("{:g}", x));
        }
        for (double y = diagram_.y_min; y <= diagram_.y_max + 1e-9 * diagram_.y_step; y += diagram_.y_step) {
            line(left, atY(y), width - right, atY(y));
            text(left - 6, atY(y) + 4, "end", fmt::format("{:g}", y));
        }
        text((left + width - right) / 2, height - 14, "middle", diagram_.x_label);
        fmt::format_to(out_, "<text transform='translate(18 {:.1f}) rotate(-90)' text-anchor='middle'>{}</text>\n",
                       (top + height - bottom) / 2, diagram_.y_label);
        for (size_t i = 0; i < diagram_.lines.size(); ++i)
            drawLine(diagram_.lines[i], top + 10 + 18.0 * static_cast<double>(i));
    }

private:
    double atX(double x) const {
        return left + (std::clamp(x, diagram_.x_min, diagram_.x_max) - diagram_.x_min) /
                          (diagram_.x_max - diagram_.x_min) * (width - right - left);
    }
    double atY(double y) const {
        return height - bottom -
               (std::clamp(y, diagram_.y_min, diagram_.y_max) - diagram_.y_min) / (diagram_.y_max - diagram_.y_min) *
                   (height - bottom - top);
    }
    void line(double x1, double y1, double x2, double y2) {
        fmt::format_to(out_, "<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke='#dde4e8'/>\n", x1, y1, x2,
                       y2);
    }
    void text(double x, double y, const char* anchor, const std::string& words) {
        fmt::format_to(out_, "<text x='{:.1f}' y='{:.1f}' text-anchor='{}'>{}</text>\n", x, y, anchor, words);
    }
    void drawLine(const Line& each, double legend_y) {
        fmt::format_to(out_, "<polyline fill='none' stroke='{}' stroke-width='1.8' points='", each.colour);
        for (const Line::Point& point : each.points) fmt::format_to(out_, "{:.1f},{:.1f} ", atX(point.x), atY(point.y));
        fmt::format_to(out_, "'/>\n<line x1='{0}' y1='{1}' x2='{2}' y2='{1}' stroke='{3}' stroke-width='3'/>\n",
                       width - right + 12, legend_y, width - right + 32, each.colour);
        text(width - right + 38, legend_y + 4, "start", each.name);
    }

    Out out_;
    const Diagram& diagram_;
};

}  // namespace

std::string linePlot(const std::vector<Diagram>& diagrams) {
    std::string svg;
    const Out out(svg);
    fmt::format_to(out,
                   "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0} {1}' width='{0}' height='{1}' "
                   "font-family='sans-serif' font-size='12'>\n<rect width='100%' height='100%' fill='white'/>\n",
                   width, height * static_cast<double>(diagrams.size()));
    for (size_t i = 0; i < diagrams.size(); ++i) {
        fmt::format_to(out, "<g transform='translate(0 {})'>\n", height * static_cast<double>(i));
        Drawing(out, diagrams[i]).draw();
        fmt::format_to(out, "</g>\n");
    }
    return svg + "</svg>\n";
}

}  // namespace insonify::study
