#include "types/geometry/Datum.hpp"

#ifdef INSONIFY_GEOGRAPHICLIB
#include <GeographicLib/LocalCartesian.hpp>
#endif

#include "types/text/ConfigError.hpp"

namespace insonify::types {

#ifdef INSONIFY_GEOGRAPHICLIB

glm::dvec3 eastNorthUp(const Datum& datum, const Datum& place) {
    const GeographicLib::LocalCartesian local(datum.latitude_deg, datum.longitude_deg, datum.height_m);
    glm::dvec3 enu;
    local.Forward(place.latitude_deg, place.longitude_deg, place.height_m, enu.x, enu.y, enu.z);
    return enu;
}

#else

glm::dvec3 eastNorthUp(const Datum&, const Datum&) {
    throw ConfigError("", "datum",
                      "cannot be used: this build has no GeographicLib; install libgeographiclib-dev and build again");
}

#endif

}  // namespace insonify::types
