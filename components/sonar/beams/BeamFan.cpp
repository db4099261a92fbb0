#include "components/sonar/beams/BeamFan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

constexpr double widest_frustum = types::radians(60);

double halfElevation(const SonarConfig& config) { return types::radians(config.beam_height_deg) / 2; }

/** Returns u where the bearing crosses the image row v: a vertical line for planes, a hyperbola for cones. */
double boundary(const SonarConfig& config, const ViewFrustum& frustum, double bearing, double v) {
    double azimuth = bearing;
    if (config.beam_geometry == BeamGeometry::Conical) {
        // v = tan(elevation) / cos(azimuth in the frustum): a few fixed-point rounds settle both.
        for (int round = 0; round < 30; ++round) {
            const double elevation = std::atan(v * std::cos(azimuth - frustum.azimuth));
            azimuth = coneAzimuth(bearing, elevation);
        }
    }
    const double inside = std::clamp(azimuth - frustum.azimuth, -frustum.half_width, frustum.half_width);
    return std::tan(inside);
}

/** The part [from, to] of the column around u; `limit` = tan of the aperture's half height. */
ShareRecord share(double from, double to, double u, double limit, uint32_t beam, uint32_t column) {
    const double middle = 0.5 * (from + to);
    return {middle, to - from, limit * std::sqrt(1 + middle * middle), u / (1 + u * u), beam, column};
}

/** Adds the beams that touch the frustum, with their edges in u, for one image row. */
void addRow(const SonarConfig& config, const Fan& beams, const ViewFrustum& frustum, double v, ColumnShares& result) {
    struct Edges {
        double low, high;
        uint32_t beam;
    };
    std::vector<Edges> edges;
    for (size_t k = 0; k < beams.size(); ++k) {
        const Edges e{boundary(config, frustum, beams[k].low, v), boundary(config, frustum, beams[k].high, v),
                      static_cast<uint32_t>(k)};
        if (e.high > e.low) edges.push_back(e);
    }
    const double limit = std::tan(halfElevation(config));
    for (int column = 0; column < frustum.columns; ++column) {
        result.starts.push_back(static_cast<uint32_t>(result.shares.size()));
        const double low = frustum.u(column), high = frustum.u(column + 1);
        for (const Edges& e : edges) {
            const double from = std::max(low, e.low), to = std::min(high, e.high);
            if (to - from > 1e-9 * (high - low))
                result.shares.push_back(
                    share(from, to, frustum.u(column + 0.5), limit, e.beam, static_cast<uint32_t>(column)));
        }
    }
}

/** One image of the whole fan, its top and bottom edges straight (ACOUSTICS.md 8.2, item 1). */
ViewFrustum publishedFrustum(const SonarConfig& config) {
    const double half_width = types::radians(config.fieldOfViewDeg()) / 2;
    return {0,
            half_width,
            config.columnsPerBeam() * config.beam_count,
            config.rows(),
            std::tan(half_width),
            std::tan(halfElevation(config))};
}

/** Returns whole columns: beam k has [round(w/2 + tan(a_k) K), round(w/2 + tan(a_k+1) K)), K = (w/2) / tan(fov/2). */
ColumnShares roundedShares(const Fan& beams, const ViewFrustum& frustum) {
    const auto column = [&](double bearing) {
        return static_cast<int>(std::lround(frustum.columns / 2.0 * (1 + std::tan(bearing) / frustum.extent_u)));
    };
    ColumnShares result;
    size_t beam = 0;
    for (int c = 0; c < frustum.columns; ++c) {
        result.starts.push_back(static_cast<uint32_t>(result.shares.size()));
        while (beam + 1 < beams.size() && column(beams[beam].high) <= c) ++beam;
        const double u = frustum.u(c + 0.5);
        result.shares.push_back({u, frustum.du(), std::numeric_limits<double>::infinity(), u / (1 + u * u),
                                 static_cast<uint32_t>(beam), static_cast<uint32_t>(c)});
    }
    result.starts.push_back(static_cast<uint32_t>(result.shares.size()));
    return result;
}

}  // namespace

double coneAzimuth(double bearing, double elevation) {
    return std::asin(std::clamp(std::sin(bearing) / std::cos(elevation), -1.0, 1.0));
}

Fan makeBeams(const SonarConfig& config) {
    std::vector<Beam> beams;
    if (!config.bearings_deg.empty()) {
        const double half = types::radians(config.beamWidthDeg()) / 2;
        for (double bearing : config.bearings_deg) {
            const double centre = types::radians(bearing);
            beams.push_back({centre, centre - half, centre + half});
        }
        return Fan(beams);
    }
    const double fov = types::radians(config.fieldOfViewDeg()), width = fov / config.beam_count;
    for (int k = 0; k < config.beam_count; ++k)
        beams.push_back({-fov / 2 + (k + 0.5) * width, -fov / 2 + k * width, -fov / 2 + (k + 1) * width});
    return Fan::sorted(std::move(beams));
}

std::vector<ViewFrustum> makeFrusta(const SonarConfig& config, const Fan& beams, const RenderOptions& options) {
    if (config.published || options.one_frustum) return {publishedFrustum(config)};
    double low = beams.low(), high = beams.high();
    const double half_elevation = halfElevation(config);
    if (config.beam_geometry == BeamGeometry::Conical) {
        low = coneAzimuth(low, half_elevation);
        high = coneAzimuth(high, half_elevation);
    }
    const int count = std::max(options.min_frusta, static_cast<int>(std::ceil((high - low) / widest_frustum - 1e-9)));
    const double columns = config.columnsPerBeam() * (high - low) / types::radians(config.beamWidthDeg()) / count;
    std::vector<ViewFrustum> frusta(static_cast<size_t>(count));
    for (int i = 0; i < count; ++i) {
        ViewFrustum& frustum = frusta[static_cast<size_t>(i)];
        frustum.half_width = (high - low) / count / 2;
        frustum.azimuth = low + (2 * i + 1) * frustum.half_width;
        frustum.samples = options.samples_per_pixel;
        const int side = frustum.samples == 4 ? 2 : 1;
        frustum.columns = side * std::max(1, static_cast<int>(std::ceil(columns - 1e-9)));
        frustum.rows = side * config.rows();
        frustum.extent_u = std::tan(frustum.half_width);
        frustum.extent_v = std::tan(half_elevation) / std::cos(frustum.half_width);
    }
    return frusta;
}

ColumnShares makeShares(const SonarConfig& config, const Fan& beams, const ViewFrustum& frustum,
                        const RenderOptions& options) {
    if (config.published || options.one_frustum) return roundedShares(beams, frustum);
    ColumnShares result;
    result.per_row = config.beam_geometry == BeamGeometry::Conical;
    for (int row = 0; row < (result.per_row ? frustum.rows : 1); ++row)
        addRow(config, beams, frustum, frustum.v(row + 0.5), result);
    result.starts.push_back(static_cast<uint32_t>(result.shares.size()));
    return result;
}

WaterView waterView(const types::Snapshot& snapshot) {
    const glm::dvec3 up = glm::inverse(glm::normalize(snapshot.sonar.orientation)) * glm::dvec3(0, 0, 1);
    return {up, snapshot.sonar.position.z - snapshot.water_surface.value_or(0)};
}

glm::dvec3 upwardIn(const ViewFrustum& frustum, const WaterView& water) {
    const double cosine = std::cos(frustum.azimuth), sine = std::sin(frustum.azimuth);
    return {cosine * water.up.x + sine * water.up.y, cosine * water.up.y - sine * water.up.x, water.up.z};
}

}  // namespace insonify::sonar
