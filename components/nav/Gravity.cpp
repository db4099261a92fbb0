#include "components/nav/Gravity.hpp"

#include <cmath>

#include "types/Angle.hpp"

namespace insonify::nav {

double normalGravity(double latitude_deg) {
    constexpr double at_equator = 9.7803253359, k = 0.00193185265241, eccentricity_squared = 0.00669437999013;
    const double sine = std::sin(types::radians(latitude_deg));
    return at_equator * (1 + k * sine * sine) / std::sqrt(1 - eccentricity_squared * sine * sine);
}

glm::dvec3 earthRotation(double latitude_deg) {
    constexpr double rate = 7.292115e-5;
    const double latitude = types::radians(latitude_deg);
    return {rate * std::cos(latitude), 0, rate * std::sin(latitude)};
}

}  // namespace insonify::nav
