#pragma once
#include "components/framework/Properties.hpp"
#include "components/sonar/tasks/PingTask.hpp"

namespace insonify::sonar {

/** Two beams, one to port and one to starboard: each narrow along the track and tall. */
struct SideScanConfig {
    SonarConfig sonar;
    double depression_deg = 30;

    SideScanConfig() {
        sonar.beam_width_deg = 0.5;
        sonar.beam_height_deg = 50;
    }
    /** Returns this sonar as one that looks straight down with its fan across the track: height becomes width, and
     *  elevation becomes azimuth. */
    SonarConfig acrossTrack() const;

    static void describe(auto& self, auto& visit) {
        SonarConfig::describeBeam(self.sonar, visit);
        visit({"depression_deg", "deg", "angle of each beam's axis below the horizontal", 0, 90}, self.depression_deg);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** A side-scan sonar: one line per ping, from two beams that look abeam and down.
 *
 *  The sonar frame is that of the vehicle, x ahead. `beam_width_deg` is the opening along the track. `beam_height_deg`
 *  is the opening across it, about an axis `depression_deg` below the horizontal. In `beam_pattern`, azimuth is along
 *  the track. Across the track there is one law, `receive.elevation`, two-way, about the axis of each beam.
 *  `quality.rows` are along the track and `columns_per_beam` across it; the defaults are 8 and 2048. In a ping beam 0
 *  is starboard, at bearing -90 deg, and beam 1 is port. */
class SideScanTask final : public PingTask {
public:
    using PingTask::PingTask;

    framework::Properties<SideScanConfig> config{this};

    SonarConfig sonarConfig() const override { return config->acrossTrack(); }

protected:
    const char* setLook(types::Snapshot& scene) override;
    void stampBearings(types::Sonar& sample) override;
};

}  // namespace insonify::sonar
