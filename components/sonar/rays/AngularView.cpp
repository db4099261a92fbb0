#include "components/sonar/rays/AngularView.hpp"

#include <algorithm>
#include <cmath>

#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

/** Returns the edges of rows as in an image, equal in tan(elevation), which has more rows where a floor is far. They
 *  are equal in elevation where an image would have too few rows near the middle [rad]. */
std::vector<double> evenEdges(double half, int rows) {
    constexpr double tallest_image = types::radians(120);
    std::vector<double> edges;
    for (int row = 0; row <= rows; ++row) {
        const double share = 2.0 * row / rows - 1;
        edges.push_back(2 * half <= tallest_image ? std::atan(std::tan(half) * share) : half * share);
    }
    return edges;
}

/** Returns the edges of rows with the density Directivity::rowDensity() [rad]. */
std::vector<double> patternEdges(double half, int rows, const Directivity& directivity) {
    constexpr int steps = 8192;
    std::vector<double> sum{0};
    for (int i = 0; i < steps; ++i)
        sum.push_back(sum.back() + directivity.rowDensity(half * ((2 * i + 1.0) / steps - 1)));
    std::vector<double> edges;
    size_t i = 0;
    for (int row = 0; row <= rows; ++row) {
        const double wanted = sum.back() * row / rows;
        while (i + 2 < sum.size() && sum[i + 1] < wanted) ++i;
        const double at = static_cast<double>(i) + (wanted - sum[i]) / (sum[i + 1] - sum[i]);
        edges.push_back(half * (2 * at / steps - 1));
    }
    return edges;
}

/** Returns the integral of cosine times pattern over elevations, by Simpson's rule in parts [1]. */
double weightedBetween(const Directivity& directivity, double low, double high) {
    constexpr int parts = 8;
    const double step = (high - low) / parts;
    const auto at = [&](double angle) { return std::cos(angle) * directivity.elevation(angle); };
    double sum = 0;
    for (int i = 0; i < parts; ++i)
        sum += at(low + i * step) + 4 * at(low + (i + 0.5) * step) + at(low + (i + 1) * step);
    return sum * step / 6;
}

std::vector<AngularView::Elevation> computeElevations(const RenderPlan& plan) {
    const double half = types::radians(plan.sampled.beam_height_deg) / 2;
    const bool weighted = plan.features.has(Feature::ElevationPattern);
    const std::vector<double> edges =
        weighted ? patternEdges(half, plan.sampled.rows(), *plan.directivity) : evenEdges(half, plan.sampled.rows());
    std::vector<AngularView::Elevation> all;
    for (size_t step = 0; step + 1 < 2 * edges.size(); ++step) {
        const double angle = step % 2 == 0 ? edges[step / 2] : 0.5 * (edges[step / 2] + edges[step / 2 + 1]);
        double sum = std::sin(angle);
        if (weighted && step == 0) sum = 0;
        if (weighted && step > 0)
            sum = all.back().weighted + weightedBetween(*plan.directivity, all.back().angle, angle);
        all.push_back({{std::cos(angle), std::sin(angle)}, angle, sum});
    }
    return all;
}

/** Returns the max samples of one triangle in one cell, so that its ranges stay within a fiftieth of a bin of the
 *  plane's. */
int maxMerged(const AngularView& view, const BinGrid& bins) {
    // Over an angle d, 1/r of a plane n.p = D deviates from the straight line between its ends by at most d d / (8 D).
    // That is a fiftieth of a bin at the far edge, on planes with a grazing angle of 15 deg. The relative error of
    // energies is d d / 24, for any length of the bins.
    constexpr double widest = 0.0085;  // [rad]
    const double angle = std::min(widest, std::sqrt(8 * 0.02 * bins.bin_width / bins.range_max / 4));
    const double cell = std::max(view.column_width, view.row_height);
    int maximum = 1;
    while (maximum < tile_samples && cell * 2 * std::sqrt(maximum) <= angle) maximum *= 4;
    return maximum;
}

}  // namespace

AngularView::Direction AngularView::computeAzimuth(double bearing, const Elevation& up) {
    const double azimuth = coneAzimuth(bearing, up.angle);
    return {std::cos(azimuth), std::sin(azimuth)};
}

AngularView makeAngularView(const RenderPlan& plan) {
    const SonarConfig& config = plan.sampled;
    const Fan& beams = plan.cells;
    AngularView view;
    view.beams = static_cast<int>(beams.size());
    view.beam_columns = config.columnsPerBeam();
    view.joined = beams.joins();
    view.rows = config.rows();
    view.conical = config.beam_geometry == BeamGeometry::Conical;
    const auto computeWidth = [](const Beam& beam) { return beam.high - beam.low; };
    view.column_width = computeWidth(beams[beams.size() / 2]) / view.beam_columns;
    view.weighted = plan.features.has(Feature::ElevationPattern);
    view.elevations = computeElevations(plan);
    view.row_height = 0;
    for (size_t row = 0; row < static_cast<size_t>(view.rows); ++row)
        view.row_height = std::max(view.row_height, view.height(row, 1));
    for (const Beam& beam : beams)
        for (int half = 0; half <= 2 * view.beam_columns; ++half) {
            const double bearing = beam.low + (beam.high - beam.low) * (0.5 * half / view.beam_columns);
            view.bearings.push_back(bearing);
            view.azimuths.push_back({std::cos(bearing), std::sin(bearing)});
        }
    for (int column = 0; column < view.beams * view.beam_columns; ++column)
        view.beam_of.push_back(column / view.beam_columns);
    return view;
}

TileShape::TileShape(const AngularView& view, const BinGrid& bins, int beams) {
    const int beam_columns = view.beam_columns, columns = beams * beam_columns;
    const int wide = columns >= 4 ? 4 : columns >= 2 ? 2 : 1;
    const int together = std::min(wide, beam_columns % 4 == 0 ? 4 : beam_columns % 2 == 0 ? 2 : 1);
    for (int count = 1; count < tile_samples; count *= 2) {
        // First the columns of one beam and rows alternately, then the other rows, then the other columns.
        const int across = size[count].columns, up = size[count].rows;
        const bool widens = across < together ? across <= up : up * wide >= tile_samples;
        size[2 * count] = {widens ? 2 * across : across, widens ? up : 2 * up};
        for (int i = 0; i < count; ++i)
            at[count + i] = {at[i].columns + (widens ? across : 0), at[i].rows + (widens ? 0 : up)};
    }
    all = size[tile_samples];
    max_merged = std::min(together * all.rows, maxMerged(view, bins));
}

}  // namespace insonify::sonar
