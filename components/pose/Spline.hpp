#pragma once
#include <array>
#include <cstddef>
#include <vector>

namespace insonify::pose {

/** A natural cubic spline: the curve through its knots whose second derivatives do not jump and are zero at its ends.
 *  Source: Press et al., "Numerical Recipes", 3rd edition, section 3.3. */
class Spline {
public:
    static constexpr size_t columns = 7;
    using Row = std::array<double, columns>;
    /** A point of the curve, and its derivative by time. */
    struct Point {
        Row value{}, rate{};
    };

    /** @param times strictly increasing [s], as many as rows, at least two. */
    Spline(std::vector<double> times, std::vector<Row> rows);

    /** In the segment that ends with a knot, 1 to the last; `time` within it [s]. */
    Point at(size_t knot, double time) const;

private:
    std::vector<double> times_;
    std::vector<Row> rows_;
    std::vector<Row> curvatures_;  ///< Second derivatives at the knots.
};

}  // namespace insonify::pose
