#include "components/sonar/AngularView.hpp"

#include <cmath>

#include "types/Angle.hpp"

namespace insonify::sonar {

glm::dvec3 AngularView::direction(int column, int row) const {
    const size_t middle = at(column) + 1;
    const Direction& up = elevations[static_cast<size_t>(2 * row + 1)];
    Direction around = azimuths[middle];
    if (conical) {
        const double azimuth = coneAzimuth(bearings[middle], std::atan2(up.sine, up.cosine));
        around = {std::cos(azimuth), std::sin(azimuth)};
    }
    return {up.cosine * around.cosine, up.cosine * around.sine, up.sine};
}

AngularView makeAngularView(const SonarConfig& config, const std::vector<Beam>& beams) {
    AngularView view;
    view.beams = static_cast<int>(beams.size());
    view.beam_columns = config.columnsPerBeam();
    view.rows = config.rows();
    view.conical = config.beam_geometry == BeamGeometry::Conical;
    view.column_width = (beams.front().high - beams.front().low) / view.beam_columns;
    const double height = types::radians(config.beam_height_deg);
    view.row_height = height / view.rows;
    for (int half = 0; half <= 2 * view.rows; ++half) {
        const double elevation = height * (0.5 * half / view.rows - 0.5);
        view.elevations.push_back({std::cos(elevation), std::sin(elevation)});
    }
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
