#include "components/acoustics/Curve.hpp"

#include <algorithm>

namespace insonify::acoustics {

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
