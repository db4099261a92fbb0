#include "components/acoustics/Backscatter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace insonify::acoustics {

using std::numbers::pi;

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

}  // namespace insonify::acoustics
