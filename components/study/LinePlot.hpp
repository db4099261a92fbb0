#pragma once
#include <string>
#include <vector>

namespace insonify::study {

/** A line of a diagram. */
struct Line {
    struct Point {
        double x, y;
    };
    std::string name, colour;
    std::vector<Point> points;
};

/** A diagram with linear axes. What lies outside of them is drawn at their ends. */
struct Diagram {
    std::string title, x_label, y_label;
    double x_min, x_max, x_step, y_min, y_max, y_step;
    std::vector<Line> lines;
};

/** Diagrams below each other, as a complete SVG image. */
std::string linePlot(const std::vector<Diagram>& diagrams);

}  // namespace insonify::study
