#pragma once
#include <cmath>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "types/text/Describe.hpp"

namespace insonify::types {

/** A place on the earth, on the ellipsoid of WGS 84: as a datum the origin of a world. Latitude and longitude must be
 *  given; they are NaN until then. */
struct Datum {
    double latitude_deg = std::numeric_limits<double>::quiet_NaN();
    double longitude_deg = std::numeric_limits<double>::quiet_NaN();
    double height_m = 0;

    bool operator==(const Datum&) const = default;
    static void describe(auto& self, auto& visit) {
        visit({"latitude_deg", "deg", "WGS 84, positive north", -90, 90}, self.latitude_deg);
        visit({"longitude_deg", "deg", "WGS 84, positive east", -360, 360}, self.longitude_deg);
        visit({"height_m", "m", "above the ellipsoid, which is not the mean sea level", -12'000, 1e5}, self.height_m);
    }
    void check(Diagnostics& diagnostics) const {
        for (const auto& [key, value] :
             {std::pair("latitude_deg", latitude_deg), std::pair("longitude_deg", longitude_deg)})
            if (std::isnan(value))
                diagnostics.push_back({key, "is missing; give latitude_deg and longitude_deg of WGS 84 [deg]"});
    }
};

/** Returns whether two places are the same to 1e-9 degrees and 0.1 mm. Longitudes may differ by whole turns. */
bool isSamePlace(const Datum& a, const Datum& b);

/** Reports as `datum` that a world has none, or that this build cannot use one because it has no GeographicLib. */
void checkDatum(const std::optional<Datum>& datum, Diagnostics& diagnostics);

/** Returns "{latitude_deg: 54.5, longitude_deg: 10.25, height_m: 0}", as a deployment has it. */
std::string text(const Datum& place);

// By GeographicLib. All throw ConfigError in a build without it.

/** Returns how far a place is east, north and up of a datum, on the axes at the datum: the earth curves down from them
 *  [m]. By LocalCartesian, exact to nanometres. */
glm::dvec3 eastNorthUp(const Datum& datum, const Datum& place);
/** Returns the place that is this far east, north and up of a datum [m]: the inverse of eastNorthUp(). The longitude is
 *  from -180 to 180 degrees; what is not finite stays so. */
Datum geodetic(const Datum& datum, const glm::dvec3& east_north_up);

/** A place on the map of a zone of UTM, or of UPS near the poles. */
struct GridPlace {
    double easting = 0, northing = 0;  ///< [m]
    int epsg = 0;                      ///< Code of the map: 32632 for zone 32 north.
};
/** Returns a place on the map of the datum's zone, also beyond the edge of the zone and of the hemisphere, so that the
 *  places about one datum share a map. By UTMUPS, exact to nanometres. Throws ConfigError more than about 4000 km off
 *  the zone. */
GridPlace gridPlace(const Datum& datum, const Datum& place);

}  // namespace insonify::types
