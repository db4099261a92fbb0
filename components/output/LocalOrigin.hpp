#pragma once
#include <fmt/format.h>

#include <cmath>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "types/Angle.hpp"

namespace insonify::output {

/** The point on the earth that becomes x = y = 0 of the world. The first position sets it. */
class LocalOrigin {
public:
    /** Returns metres north and east of the origin [m]; WGS 84, on the tangent plane at the origin. */
    glm::dvec2 fromDegrees(double latitude, double longitude) {
        if (!origin_) set({latitude, longitude}, "latitude {:.7f}, longitude {:.7f} (WGS 84)");
        constexpr double radius = 6378137, e2 = 6.69437999014e-3;  // [m], [1]
        const double latitude_rad = types::radians(origin_->x), sine = std::sin(latitude_rad);
        const double across = radius / std::sqrt(1 - e2 * sine * sine);  // radius of curvature, east to west
        const double along = across * (1 - e2) / (1 - e2 * sine * sine);
        return {types::radians(latitude - origin_->x) * along,
                types::radians(std::remainder(longitude - origin_->y, 360)) * across * std::cos(latitude_rad)};
    }
    /** Returns metres north and east of the origin [m]. The origin is that of the coordinates, unless the first are too
     *  large to be local; then it is the first position. */
    glm::dvec2 fromMetres(double north, double east) {
        constexpr double local = 1e4;
        const bool is_local = std::abs(north) <= local && std::abs(east) <= local;
        if (!origin_) set(is_local ? glm::dvec2(0) : glm::dvec2(north, east), "north {:.2f} m, east {:.2f} m");
        return glm::dvec2(north, east) - *origin_;
    }
    /** Returns the origin as in the file; empty before the first position. */
    const std::string& text() const { return text_; }

private:
    void set(glm::dvec2 origin, const char* format) {
        origin_ = origin;
        text_ = fmt::format(fmt::runtime(format), origin.x, origin.y);
    }

    std::optional<glm::dvec2> origin_;
    std::string text_;
};

}  // namespace insonify::output
