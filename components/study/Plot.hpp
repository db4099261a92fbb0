#pragma once
#include <string>
#include <vector>

namespace insonify::study {

/** A line of a diagram with linear axes. */
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

/** A line of a diagram with logarithmic axes; points need both coordinates above 0. */
struct Curve {
    struct Point {
        double x, y;
        bool marked;  ///< Drawn with a ring.
    };
    std::string name, colour;
    std::vector<Point> points;
};

/** A value that all points are seen against: a dashed line across. */
struct Level {
    std::string name;
    double y;
};

/** A diagram with logarithmic axes, as a complete SVG image. */
std::string logLogPlot(const std::string& title, const std::string& x_label, const std::string& y_label,
                       const std::vector<Curve>& curves, const std::vector<Level>& levels = {});

}  // namespace insonify::study
