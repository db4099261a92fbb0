#include "components/acoustics/BackscatterTable.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace insonify::acoustics {
namespace {

using std::numbers::pi;

const double min_cosine = std::sin(0.001 * pi / 180);

}  // namespace

BackscatterTable::BackscatterTable(const std::function<double(double)>& section) {
    for (int i = 0; i < entries; ++i) {
        const double cosine = std::max(min_cosine, static_cast<double>(i) / (entries - 1));
        values_[static_cast<size_t>(i)] = section(std::asin(cosine)) / cosine;
    }
}

Curve readBackscatter(const std::string& file) {
    return readCurve(file, {"grazing_deg", 0, 90}, {"strength_db", -300, 100});
}

double measuredSection(const Curve& measured, double grazing) {
    return std::pow(10, measured.at(grazing * 180 / pi) / 10);
}

}  // namespace insonify::acoustics
