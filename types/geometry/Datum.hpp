#pragma once
#include <glm/vec3.hpp>

#include "types/text/Describe.hpp"

namespace insonify::types {

/** A place on the earth, on the ellipsoid of WGS 84: as a datum the origin of a world. */
struct Datum {
    double latitude_deg = 0, longitude_deg = 0;
    double height_m = 0;

    bool operator==(const Datum&) const = default;
    static void describe(auto& self, auto& visit) {
        visit({"latitude_deg", "deg", "WGS 84, positive north", -90, 90}, self.latitude_deg);
        visit({"longitude_deg", "deg", "WGS 84, positive east", -360, 360}, self.longitude_deg);
        visit({"height_m", "m", "above the ellipsoid, which is not the mean sea level", -12'000, 1e5}, self.height_m);
    }
};

/** Returns how far a place is east, north and up of a datum, on the axes at the datum: the earth curves down from them
 *  [m]. By GeographicLib's LocalCartesian, exact to nanometres. Throws ConfigError in a build without GeographicLib. */
glm::dvec3 eastNorthUp(const Datum& datum, const Datum& place);

}  // namespace insonify::types
