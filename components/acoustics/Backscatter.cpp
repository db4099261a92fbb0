#include "components/acoustics/Backscatter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace insonify::acoustics {
namespace {

using std::numbers::pi;

const double min_cosine = std::sin(0.001 * pi / 180);

}  // namespace

double lambertSection(double lambert_db, double cos_incidence) {
    return std::pow(10, lambert_db / 10) * cos_incidence * cos_incidence;
}

double Slopes::meanSquare() const {
    return roughness * roughness + mesh * mesh + wavelength * wavelength / (4 * pi * cell_area);
}

double objectSection(double lambert_db, double reflection, double mean_square_slope, double cos_incidence) {
    constexpr double grazing = 1e-10;  // no lobe reaches it, and 0 would divide
    const double square = std::max(cos_incidence * cos_incidence, grazing), tangent_square = (1 - square) / square;
    const double lobe = std::exp(-tangent_square / mean_square_slope) / (square * square);
    return lambertSection(lambert_db, cos_incidence) + reflection * reflection * lobe / (4 * pi * mean_square_slope);
}

double solidSection(const RoughSurface& surface, double grazing) {
    constexpr double nothing_db = -3000, min_square_slope = 1e-12;  // to be finite
    const double reflection = surface.reflection() * std::sqrt(surface.lobeShare());
    return surface.diffuse(grazing) +
           objectSection(nothing_db, reflection, std::max(surface.squareSlope(), min_square_slope), std::sin(grazing));
}

double BackscatterTable::computeCosine(int entry) {
    constexpr int low = 256, high = 768;  // entries at 1/16 and 15/16
    if (entry <= low) return std::max(min_cosine, entry / 4096.0);
    if (entry <= high) return 1.0 / 16 + (entry - low) * (7 / 4096.0);
    return 15.0 / 16 + (entry - high) / 4080.0;
}

BackscatterTable::BackscatterTable(const std::function<double(double)>& section) {
    for (int i = 0; i < entries; ++i) {
        const double cosine = computeCosine(i);
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
