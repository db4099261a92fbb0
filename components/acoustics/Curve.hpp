#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "types/text/Csv.hpp"

namespace insonify::acoustics {

/** A function of one variable as straight lines between places that are close where it bends. Copies share the places.
 *
 *  Between its ends the table is within `relative` of the function's value, or within `absolute` of it. The bound is
 *  tested at three points within each line, with half of it. It cannot see what is narrower than a third of the first
 *  cells: `cells` equal parts of the whole, each at least one line. */
class AdaptiveTable {
public:
    struct Bound {
        double relative, absolute;
    };

    AdaptiveTable() = default;
    /** @param low,high  ends of the table, low < high
     *  @param cells  above 0 */
    AdaptiveTable(const std::function<double(double)>& function, double low, double high, const Bound& bound,
                  size_t cells);

    bool empty() const { return !lines_; }
    /** Returns the value at x; outside of the table that of the nearer end. 0 for an empty table. */
    double at(double x) const;
    size_t size() const { return lines_ ? lines_->x.size() : 0; }  ///< Number of places [1].

    static constexpr size_t max_places = size_t{1} << 18;  ///< Beyond it lines are no longer halved.

private:
    struct Lines {
        double low, per_cell;         ///< [1], cells per unit.
        std::vector<uint32_t> first;  ///< Place at the start of each cell, and the last place.
        std::vector<double> x, y;     ///< Ascending places, and the function there.
    };
    std::shared_ptr<const Lines> lines_;
};

/** A measured curve: y over ascending x, linearly interpolated. */
struct Curve {
    std::vector<double> x, y;

    /** Returns the value at `where`; outside the curve, the value of the nearer end. */
    double at(double where) const;
};

/** Reads a CSV file of two named columns, the first ascending.
 *  @throws types::ConfigError with file, line and column of every diagnostic. */
Curve readCurve(const std::string& file, const types::CsvColumn& x, const types::CsvColumn& y);

}  // namespace insonify::acoustics
