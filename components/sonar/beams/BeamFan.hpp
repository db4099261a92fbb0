#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "components/sonar/beams/Fan.hpp"
#include "components/sonar/config/RenderOptions.hpp"
#include "components/sonar/config/SonarConfig.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::sonar {

/** Returns the beams of a configuration: a regular fan, or the explicit table. */
Fan makeBeams(const SonarConfig& config);

/** Returns the azimuth at which a cone of bearing `bearing` meets elevation `elevation`; clamped to +-90 deg [rad]. */
double coneAzimuth(double bearing, double elevation);

/** One perspective image of the fan. u = tan(azimuth - centre), growing to port; v = tan(elevation) / cos(...). */
struct ViewFrustum {
    double azimuth = 0;     ///< Azimuth of the image's centre in the sonar frame [rad].
    double half_width = 0;  ///< [rad]
    int columns = 0, rows = 0;
    double extent_u = 0;  ///< u at the left edge: tan(half_width) [1].
    double extent_v = 0;  ///< v at the top edge [1].
    int samples = 1;      ///< 4: two columns and rows are one pixel of the device, its samples on a rotated grid [1].

    double du() const { return 2 * extent_u / columns; }
    double dv() const { return 2 * extent_v / rows; }
    uint64_t pixels() const { return static_cast<uint64_t>(columns) * static_cast<uint64_t>(rows); }
    double u(double column) const { return column * du() - extent_u; }
    double v(double row) const { return row * dv() - extent_v; }
};

/** Max rows or columns of an image: what every OpenGL 4.5 device can rasterise [1]. */
constexpr int max_image_size = 16384;

/** Max elevation angle of an image [deg]. */
constexpr double tallest_image_deg = 150;

/** Returns the smallest number of frusta, of at most 60 deg, that cover the beams (ACOUSTICS.md 5.3); cones reach wider
 *  than their bearing. Returns one frustum with `published`. */
std::vector<ViewFrustum> makeFrusta(const SonarConfig& config, const Fan& beams, const RenderOptions& options = {});

/** The part of an image column that belongs to one beam; u = tan(azimuth in the frustum). */
struct ShareRecord {
    double middle, width;  ///< In u [1].
    double limit;          ///< The aperture ends at v = +-limit in this part [1].
    double shear;  ///< u / (1 + u u) at the column's middle: slope of curves of constant elevation is v * shear [1].
    uint32_t beam, column;
};

/** Overlap of columns and beams: fractional, or with `published` rounded to whole columns. Planar beams: one row of
 *  columns serves all image rows. */
struct ColumnShares {
    std::vector<uint32_t> starts;  ///< Shares of (row, column) begin at starts[row * columns + column].
    std::vector<ShareRecord> shares;
    bool per_row = false;  ///< Conical beams: the boundary between beams bends with elevation.

    size_t cell(int row, int column, int columns) const {
        return static_cast<size_t>(per_row ? row : 0) * static_cast<size_t>(columns) + static_cast<size_t>(column);
    }
};

ColumnShares makeShares(const SonarConfig& config, const Fan& beams, const ViewFrustum& frustum,
                        const RenderOptions& options = {});

/** Direction of a point from a sonar, in the angles of its beams [rad]. */
struct BeamAngles {
    double azimuth;    ///< Positive to port: about the z-axis; conical: above the plane normal to the y-axis.
    double elevation;  ///< Above the sonar's plane.
};

/** Returns the azimuth of a unit direction in the sonar's axes; for a conical fan the bearing of its cone [rad]. */
inline double beamAzimuth(const glm::dvec3& direction, bool conical) {
    return conical ? std::asin(std::clamp(direction.y, -1.0, 1.0)) : std::atan2(direction.y, direction.x);
}

/** Returns the angles of a point in the sonar's axes [m]; 0, 0 for the sonar's own place. */
inline BeamAngles beamAngles(const glm::dvec3& at, bool conical) {
    const glm::dvec3 direction = at / std::max(glm::length(at), 1e-12);
    return {beamAzimuth(direction, conical), std::asin(std::clamp(direction.z, -1.0, 1.0))};
}

/** Orientation and height of the sonar of one ping in the water. */
struct WaterView {
    glm::dvec3 up{0, 0, 1};  ///< The world's z in sonar axes, unit [1].
    double height = 0;       ///< Height of the sonar above the water surface, or above the world's z = 0 [m].
};
WaterView waterView(const types::Snapshot& snapshot);

/** Returns the world's up in the axes of a frustum. */
glm::dvec3 upwardIn(const ViewFrustum& frustum, const WaterView& water);

}  // namespace insonify::sonar
