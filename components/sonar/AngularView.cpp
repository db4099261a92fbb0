#include "components/sonar/AngularView.hpp"

#include <algorithm>
#include <cmath>

#include "types/Angle.hpp"

namespace insonify::sonar {

AngularView::Direction AngularView::azimuthOf(double bearing, const Elevation& up) {
    const double azimuth = coneAzimuth(bearing, up.angle);
    return {std::cos(azimuth), std::sin(azimuth)};
}

namespace {

/** Rows as those of an image, equal in tan(elevation), which has more of them where a floor is far; equal in elevation
 *  where that would leave too few to the middle. */
std::vector<AngularView::Elevation> elevationsOf(const SonarConfig& config, int rows) {
    constexpr double tallest_image = types::radians(120);
    const double half = types::radians(config.beam_height_deg) / 2;
    const auto edge = [&](int row) {
        const double share = 2.0 * row / rows - 1;
        return 2 * half <= tallest_image ? std::atan(std::tan(half) * share) : half * share;
    };
    std::vector<AngularView::Elevation> all;
    for (int step = 0; step <= 2 * rows; ++step) {
        const double angle = step % 2 == 0 ? edge(step / 2) : 0.5 * (edge(step / 2) + edge(step / 2 + 1));
        all.push_back({std::cos(angle), std::sin(angle), angle});
    }
    return all;
}

}  // namespace

AngularView makeAngularView(const SonarConfig& config, const std::vector<Beam>& beams) {
    AngularView view;
    view.beams = static_cast<int>(beams.size());
    view.beam_columns = config.columnsPerBeam();
    view.rows = config.rows();
    view.conical = config.beam_geometry == BeamGeometry::Conical;
    view.column_width = (beams.front().high - beams.front().low) / view.beam_columns;
    view.elevations = elevationsOf(config, view.rows);
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

}  // namespace insonify::sonar
