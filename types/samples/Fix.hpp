#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "types/Time.hpp"
#include "types/geometry/Datum.hpp"
#include "types/geometry/WorldFrame.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::types {

/** The values of Rock. */
enum class FixKind : int32_t {
    NoSolution = 0,
    Autonomous = 1,
    Differential = 2,
    Invalid = 3,
    RtkFixed = 4,
    RtkFloat = 5,
    Autonomous2d = 6
};

/** The position of a receiver of satellites, field for field Rock's gps_base::Solution. NaN means unknown. */
struct Fix {
    static constexpr const char* type_name = "/gps_base/Solution";
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    Time time;
    double latitude = unknown, longitude = unknown;
    FixKind kind = FixKind::NoSolution;
    int32_t satellites = 0;
    double altitude = unknown, geoidal_separation = 0;
    double correction_age = unknown;
    double deviation_latitude = unknown, deviation_longitude = unknown, deviation_altitude = unknown;

    /** Whether it is a place on the earth, of any or unknown height up to 10,000 km. */
    bool hasPosition() const {
        constexpr double max_height = 1e7;  // [m]
        return kind != FixKind::NoSolution && kind != FixKind::Invalid && std::abs(latitude) <= 90 &&
               std::abs(longitude) <= 360 && !(std::abs(place().height_m) > max_height);
    }
    /** Returns the place on the ellipsoid of WGS 84; its height is NaN if the altitude is unknown. */
    Datum place() const { return {latitude, longitude, altitude + geoidal_separation}; }

    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "when the position was true in the world"}, self.time);
        visit({"latitude", "deg", "WGS 84, positive north"}, self.latitude);
        visit({"longitude", "deg", "WGS 84, positive east"}, self.longitude);
        visit({"positionType", "1", "0 no solution, 1 autonomous, 2 differential, others as in Rock"}, self.kind);
        visit({"noOfSatellites", "1", "satellites used; 0: unknown"}, self.satellites);
        visit({"altitude", "m", "above the geoid"}, self.altitude);
        visit({"geoidalSeparation", "m", "of the geoid above the ellipsoid; 0: the altitude is above the ellipsoid"},
              self.geoidal_separation);
        visit({"ageOfDifferentialCorrections", "s", "NaN: unknown"}, self.correction_age);
        visit({"deviationLatitude", "m", "standard deviation to the north"}, self.deviation_latitude);
        visit({"deviationLongitude", "m", "standard deviation to the east"}, self.deviation_longitude);
        visit({"deviationAltitude", "m", "standard deviation of the altitude"}, self.deviation_altitude);
    }
};

/** Distance from the datum beyond which a fix probably belongs to another datum [m]. */
inline constexpr double far_from_datum = 1e5;

/** Returns the pose of the antenna about a datum, in Rock's axes, level and looking to the north, with the variances of
 *  the fix. An unknown height is the datum's. Returns nothing for a fix without a position. The
 *  variances are taken as along the axes at the datum; 100 km away those at the fix differ by a degree. Throws
 *  ConfigError in a build without GeographicLib. */
inline std::optional<Pose> placeFix(const Fix& fix, const Datum& datum) {
    if (!fix.hasPosition()) return std::nullopt;
    Datum place = fix.place();
    if (std::isnan(place.height_m)) place.height_m = datum.height_m;
    Pose pose;
    pose.time = fix.time;
    pose.position = Axes{WorldFrame::Enu}.rockFromWorld(eastNorthUp(datum, place));
    const glm::dvec3 deviations(fix.deviation_latitude, fix.deviation_longitude, fix.deviation_altitude);
    if (!std::isfinite(glm::dot(deviations, deviations))) return pose;
    pose.cov_position = glm::dmat3(0);
    for (int axis = 0; axis < 3; ++axis) pose.cov_position[axis][axis] = deviations[axis] * deviations[axis];
    return pose;
}

template <>
struct EnumTable<FixKind> {
    static constexpr const char* name = "/gps_base/GPS_SOLUTION_TYPES";
    static constexpr EnumSymbol symbols[] = {{"NO_SOLUTION", 0}, {"AUTONOMOUS", 1}, {"DIFFERENTIAL", 2}, {"INVALID", 3},
                                             {"RTK_FIXED", 4},   {"RTK_FLOAT", 5},  {"AUTONOMOUS_2D", 6}};
};

}  // namespace insonify::types
