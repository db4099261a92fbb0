#pragma once
#include <string>
#include <vector>

namespace insonify::study {

/** A line of a diagram; points need both coordinates above 0. */
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
