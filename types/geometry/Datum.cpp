#include "types/geometry/Datum.hpp"

#include <cstdio>

#ifdef INSONIFY_GEOGRAPHICLIB
#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/UTMUPS.hpp>
#endif

#include "types/text/ConfigError.hpp"

namespace insonify::types {

bool isSamePlace(const Datum& a, const Datum& b) {
    constexpr double degrees = 1e-9, metres = 1e-4;
    return std::abs(a.latitude_deg - b.latitude_deg) <= degrees &&
           std::abs(std::remainder(a.longitude_deg - b.longitude_deg, 360)) <= degrees &&
           std::abs(a.height_m - b.height_m) <= metres;
}

void checkDatum(const std::optional<Datum>& datum, Diagnostics& diagnostics) try {
    if (datum)
        geodetic(*datum, {});
    else
        diagnostics.push_back({"datum",
                               "is missing; give the deployment, next to its tasks, the world's origin on the earth: "
                               "datum: {latitude_deg: 54.5, longitude_deg: 10.25}"});
} catch (const ConfigError& error) {
    diagnostics.push_back({"datum", error.diagnostics().front().message});
}

std::string text(const Datum& place) {
    char text[160];
    std::snprintf(text, sizeof text, "{latitude_deg: %.12g, longitude_deg: %.12g, height_m: %.9g}", place.latitude_deg,
                  place.longitude_deg, place.height_m);
    return text;
}

#ifdef INSONIFY_GEOGRAPHICLIB

namespace {

GeographicLib::LocalCartesian axesAt(const Datum& datum) {
    return {datum.latitude_deg, datum.longitude_deg, datum.height_m};
}

}  // namespace

glm::dvec3 eastNorthUp(const Datum& datum, const Datum& place) {
    glm::dvec3 enu;
    axesAt(datum).Forward(place.latitude_deg, place.longitude_deg, place.height_m, enu.x, enu.y, enu.z);
    return enu;
}

Datum geodetic(const Datum& datum, const glm::dvec3& enu) {
    Datum place;
    axesAt(datum).Reverse(enu.x, enu.y, enu.z, place.latitude_deg, place.longitude_deg, place.height_m);
    return place;
}

GridPlace gridPlace(const Datum& datum, const Datum& place) try {
    using GeographicLib::UTMUPS;
    const int zone = UTMUPS::StandardZone(datum.latitude_deg, datum.longitude_deg);
    const bool is_north = datum.latitude_deg >= 0;
    GridPlace on_map{NAN, NAN, UTMUPS::EncodeEPSG(zone, is_north)};
    if (!std::isfinite(place.latitude_deg + place.longitude_deg)) return on_map;
    int own_zone = zone;
    bool own_north = is_north;
    UTMUPS::Forward(place.latitude_deg, place.longitude_deg, own_zone, own_north, on_map.easting, on_map.northing,
                    zone);
    UTMUPS::Transfer(own_zone, own_north, on_map.easting, on_map.northing, zone, is_north, on_map.easting,
                     on_map.northing, own_zone);
    return on_map;
} catch (const GeographicLib::GeographicErr& error) {
    throw ConfigError("", "datum", text(datum) + " has no map for " + text(place) + ": " + error.what());
}

#else

namespace {

[[noreturn]] void refuseWithout() {
    throw ConfigError("", "datum",
                      "cannot be used: this build has no GeographicLib; install libgeographiclib-dev and build again");
}

}  // namespace

glm::dvec3 eastNorthUp(const Datum&, const Datum&) { refuseWithout(); }
Datum geodetic(const Datum&, const glm::dvec3&) { refuseWithout(); }
GridPlace gridPlace(const Datum&, const Datum&) { refuseWithout(); }

#endif

}  // namespace insonify::types
