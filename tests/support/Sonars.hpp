#pragma once
// Small forward-looking sonars, and their pings.
#include <optional>

#include "components/sonar/renderer/SonarRenderer.hpp"

namespace insonify::test {

/** Settings of a sonar that most tests use. An absent setting has the default of sonar::SonarConfig. */
struct Fan {
    int beams = 1;
    std::optional<double> width_deg = {};  ///< Total width of all beams.
    double height_deg = 20;                ///< Aperture in elevation.
    int bins = 300;
    double bin = 0.1;                            ///< Length of each bin [m].
    std::optional<int> rows = {}, columns = {};  ///< Rows and columns of samples; the columns are per beam.
};

/** A sonar in water of 1000 m/s, where a bin of 0.1 m lasts 100 us. */
inline sonar::SonarConfig getSonar(const Fan& fan) {
    sonar::SonarConfig config;
    config.speed_of_sound = 1000;
    config.range = fan.bin * fan.bins;
    config.bin_count = fan.bins;
    config.beam_count = fan.beams;
    config.field_of_view_deg = fan.width_deg;
    config.beam_height_deg = fan.height_deg;
    config.quality.rows = fan.rows;
    config.quality.columns_per_beam = fan.columns;
    return config;
}

/** Returns the first ping of a sonar. */
inline types::Sonar makePing(const sonar::SonarConfig& config, const types::Snapshot& snapshot,
                             const sonar::RenderOptions& options = {}) {
    sonar::SonarRenderer renderer(config, snapshot.geometry, options);
    types::Sonar ping;
    renderer.render(snapshot, ping);
    return ping;
}

}  // namespace insonify::test
