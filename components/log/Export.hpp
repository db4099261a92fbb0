#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "components/log/Reader.hpp"
#include "types/geometry/Datum.hpp"

namespace insonify::log {

/** Writes a stream as numpy arrays and returns the files.
 *
 *  Pings, and beams and scans as pings: `bins` [pings, beams, bins] float32, `bearings` [pings, beams] rad, `time`
 *  [pings] s, `bin_duration` [pings] s (one-way), `speed_of_sound` [pings] m/s, `range_m` [pings, bins] float32 m, of
 *  the middle of each bin. Pictures: `pixels` [pictures, rows, columns, bytes of a pixel] uint8, `time` s. When the
 *  shape changes, a new file begins: x.0.npz, x.1.npz.
 *  Truth of pings: `elevation`, `object`, `share`, `hits`, `grazing`, `path` and `shadow` [pings, beams, bins], as in
 *  types::SonarTruth, `objects` (names), `time`, `bearings`, `range_m`. Returns of pings: `first_range` and the other
 *  fields of types::SonarReturns [pings, beams], `time`, `bearings`. Detections: `elevation`, `travel_time` and
 * `intensity` [pings, beams], `speed_of_sound` [pings], `time`, `bearings`. Elements of pings: `in_phase`, `quadrature`
 *  [pings, elements, samples], `positions`, `weights` [pings, elements], `range_m` [pings, samples], `wavelength`,
 *  `speed_of_sound`, `time`, as in types::SonarElements.
 *  Points: `time` s, `points` [n, 3] m, `intensity`, of each point. Maps of distances: `distances`, `remissions` [maps,
 *  rows, columns], `time`, and the angles of the last map. Ranges: `time`, `range`. Poses: `time` s, `position` [n, 3]
 *  m, `orientation` [n, 4] (w, x, y, z), and where one states them `velocity` [n, 3] m/s, `angular_velocity` [n, 3]
 *  rad/s. Numbers, texts, times [s] and angles [rad]: `time`, `value`. If `meta` is not
 *  empty, it is added as one text. Throws ConfigError for a missing stream or one of another type, std::runtime_error
 *  on a full disk. */
std::vector<std::filesystem::path> exportNpz(Reader& log, const std::string& stream, const std::filesystem::path& path,
                                             const std::string& meta = "");

/** How points are placed on the earth. */
struct EarthColumns {
    types::Datum datum;    ///< Origin of the world.
    bool on_grid = false;  ///< On the map of the datum's zone of UTM or UPS, not by latitude and longitude.
};

/** Writes a stream as text. Pings, beams and scans: `time,beam,bearing,bin,value`, one line per bin [s, 1, rad, 1, 1].
 *  Truth: the same with `elevation,object,share,hits,grazing,path,shadow` instead of the value. Returns:
 *  `time,beam,bearing` and their fields. Elements: `time,element,position,sample,in_phase,quadrature`. Points:
 *  `time,x,y,z,intensity`, with `earth` also `latitude_deg,longitude_deg,height_m` or `easting,northing,height_m,epsg`.
 * Maps: `time,row,column,distance,remission`. Ranges: `time,range`. Poses: `time,x,y,z,qw,qx,qy,qz`, the columns of a
 * trajectory file [s, m, 1], and `vx,vy,vz,wx,wy,wz` where one states velocities [m/s, rad/s]. Numbers, texts, times
 * [s] and angles [rad]: `time,value`. Throws as exportNpz. */
void exportCsv(Reader& log, const std::string& stream, const std::filesystem::path& path,
               const std::optional<EarthColumns>& earth = {});

}  // namespace insonify::log
