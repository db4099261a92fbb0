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

double BackscatterTable::overCosine(double cos_incidence) const {
    const double place = std::clamp(cos_incidence, 0.0, 1.0) * (entries - 1);
    const auto low = std::min(static_cast<size_t>(place), static_cast<size_t>(entries - 2));
    const double part = place - static_cast<double>(low);
    return values_[low] + part * (values_[low + 1] - values_[low]);
}

Curve readBackscatter(const std::string& file) {
    return readCurve(file, {"grazing_deg", 0, 90}, {"strength_db", -300, 100});
}

double measuredSection(const Curve& measured, double grazing) {
    return std::pow(10, measured.at(grazing * 180 / pi) / 10);
}

}  // namespace insonify::acoustics
