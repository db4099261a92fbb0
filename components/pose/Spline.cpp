#include "components/pose/Spline.hpp"

#include <utility>

namespace insonify::pose {
namespace {

/** Second derivatives of one column at its knots: a tridiagonal system, zero at both ends. */
std::vector<double> curvaturesOf(const std::vector<double>& times, const std::vector<Spline::Row>& rows,
                                 size_t column) {
    const size_t count = times.size();
    std::vector<double> curvature(count, 0), factor(count, 0);
    const auto slope = [&](size_t i) { return (rows[i + 1][column] - rows[i][column]) / (times[i + 1] - times[i]); };
    for (size_t i = 1; i + 1 < count; ++i) {
        const double before = times[i] - times[i - 1], after = times[i + 1] - times[i];
        const double pivot = 2 * (before + after) - before * factor[i - 1];
        factor[i] = after / pivot;
        curvature[i] = (6 * (slope(i) - slope(i - 1)) - before * curvature[i - 1]) / pivot;
    }
    for (size_t i = count - 1; i-- > 1;) curvature[i] -= factor[i] * curvature[i + 1];
    return curvature;
}

}  // namespace

Spline::Spline(std::vector<double> times, std::vector<Row> rows)
    : times_(std::move(times)), rows_(std::move(rows)), curvatures_(rows_.size()) {
    for (size_t column = 0; column < columns; ++column) {
        const std::vector<double> curvature = curvaturesOf(times_, rows_, column);
        for (size_t i = 0; i < curvature.size(); ++i) curvatures_[i][column] = curvature[i];
    }
}

Spline::Point Spline::at(size_t knot, double time) const {
    const double length = times_[knot] - times_[knot - 1];
    const double b = (time - times_[knot - 1]) / length, a = 1 - b;
    const Row &from = rows_[knot - 1], &to = rows_[knot];
    const Row &bent_from = curvatures_[knot - 1], &bent_to = curvatures_[knot];
    Point point;
    for (size_t i = 0; i < columns; ++i) {
        point.value[i] = a * from[i] + b * to[i] +
                         ((a * a * a - a) * bent_from[i] + (b * b * b - b) * bent_to[i]) * length * length / 6;
        point.rate[i] =
            (to[i] - from[i]) / length + ((3 * b * b - 1) * bent_to[i] - (3 * a * a - 1) * bent_from[i]) * length / 6;
    }
    return point;
}

}  // namespace insonify::pose
