#include "components/acoustics/Curve.hpp"

#include <algorithm>
#include <cmath>

namespace insonify::acoustics {
namespace {

constexpr int deepest = 24;  ///< Halvings of a cell.
constexpr double safety = 0.5;

/** Halves lines until the function is close to them. */
class Refining {
public:
    Refining(const std::function<double(double)>& function, const AdaptiveTable::Bound& bound, std::vector<double>& x,
             std::vector<double>& y)
        : function_(function), bound_(bound), x_(x), y_(y) {}

    /** Adds the places of the line from `low` on, without its end. */
    void add(double low, double at_low, double high, double at_high, int depth = 0) {
        const double quarter = (high - low) / 4, middle = low + 2 * quarter;
        const double at_quarter = function_(low + quarter), at_middle = function_(middle),
                     at_last = function_(high - quarter);
        const auto isClose = [&](double value, double share) {
            const double off = std::abs(value - (at_low + share * (at_high - at_low)));
            return off <= safety * (bound_.relative * std::abs(value) + bound_.absolute);
        };
        const bool close = isClose(at_quarter, 0.25) && isClose(at_middle, 0.5) && isClose(at_last, 0.75);
        if (close || depth == deepest || x_.size() > AdaptiveTable::max_places) {
            x_.push_back(low);
            y_.push_back(at_low);
            return;
        }
        add(low, at_low, middle, at_middle, depth + 1);
        add(middle, at_middle, high, at_high, depth + 1);
    }

private:
    const std::function<double(double)>& function_;
    const AdaptiveTable::Bound& bound_;
    std::vector<double>&x_, &y_;
};

}  // namespace

AdaptiveTable::AdaptiveTable(const std::function<double(double)>& function, double low, double high, const Bound& bound,
                             size_t cells) {
    auto lines = std::make_shared<Lines>();
    lines->low = low;
    lines->per_cell = static_cast<double>(cells) / (high - low);
    Refining refining(function, bound, lines->x, lines->y);
    const auto edge = [&](size_t i) {
        return low + (high - low) * static_cast<double>(i) / static_cast<double>(cells);
    };
    double at_edge = function(low);
    for (size_t i = 0; i < cells; ++i) {
        const double at_next = function(edge(i + 1));
        lines->first.push_back(static_cast<uint32_t>(lines->x.size()));
        refining.add(edge(i), at_edge, edge(i + 1), at_next);
        at_edge = at_next;
    }
    lines->first.push_back(static_cast<uint32_t>(lines->x.size()));
    lines->x.push_back(high);
    lines->y.push_back(at_edge);
    lines_ = std::move(lines);
}

double AdaptiveTable::at(double x) const {
    if (!lines_) return 0;
    const Lines& lines = *lines_;
    const double place = std::clamp((x - lines.low) * lines.per_cell, 0.0, static_cast<double>(lines.first.size() - 2));
    const auto cell = static_cast<size_t>(place);
    const auto begin = lines.x.begin();
    const auto after = std::upper_bound(begin + lines.first[cell] + 1, begin + lines.first[cell + 1], x);
    const auto i = static_cast<size_t>(after - begin);
    const double share = std::clamp((x - lines.x[i - 1]) / (lines.x[i] - lines.x[i - 1]), 0.0, 1.0);
    return lines.y[i - 1] + share * (lines.y[i] - lines.y[i - 1]);
}

double Curve::at(double where) const {
    const auto above = std::upper_bound(x.begin(), x.end(), where);
    if (above == x.begin()) return y.front();
    if (above == x.end()) return y.back();
    const auto i = static_cast<size_t>(above - x.begin());
    return y[i - 1] + (y[i] - y[i - 1]) * (where - x[i - 1]) / (x[i] - x[i - 1]);
}

Curve readCurve(const std::string& file, const types::CsvColumn& x, const types::CsvColumn& y) {
    const auto ascends = [](const std::vector<double>& row, const std::vector<double>* before) {
        std::vector<types::CsvDiagnostic> diagnostics;
        if (before && !(row[0] > before->front()))
            diagnostics.push_back({0, "is not above that of the line before; it must increase"});
        return diagnostics;
    };
    Curve curve;
    for (const std::vector<double>& row : types::readCsv(file, {x, y}, 2, ascends)) {
        curve.x.push_back(row[0]);
        curve.y.push_back(row[1]);
    }
    return curve;
}

}  // namespace insonify::acoustics
