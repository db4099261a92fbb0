#pragma once
#include "components/framework/Properties.hpp"
#include "components/sonar/bins/Detection.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "types/samples/Range.hpp"

namespace insonify::sonar {

/** One beam, and the detection of its first return. */
struct AltimeterConfig {
    SonarConfig sonar;
    DetectionConfig detection;

    AltimeterConfig() {
        sonar.beam_width_deg = sonar.beam_height_deg = 25;
        detection.threshold_db = -20;
    }
    /** Returns the sonar with its one beam at bearing 0. */
    SonarConfig beam() const;

    static void describe(auto& self, auto& visit) {
        SonarConfig::describeBeam(self.sonar, visit);
        DetectionConfig::describeThreshold(self.detection, visit);
    }
    void check(types::Diagnostics& diagnostics) const { beam().checkBeam(diagnostics); }
};

/** An altimeter, or an echo sounder: one beam, and the range to its first return.
 *
 *  The beam looks along x of the sonar frame. It is `beam_width_deg` wide about z and `beam_height_deg` about y: a
 *  mount with `pitch_deg: 90` looks straight down. In addition to the ping it writes `range`: the middle of the first
 *  bin that reaches the threshold, in the noiseless ping without spreading, ring-down and water. Where no bin does, it
 *  is types::Range::too_near if there is a surface in the beam nearer than `range_min`, else NaN. */
class AltimeterTask final : public PingTask {
public:
    using PingTask::PingTask;

    framework::Properties<AltimeterConfig> config{this};
    framework::OutputPort<types::Range> range{this, "range", "to the first return, at the time of the ping"};

    SonarConfig sonarConfig() const override { return config->beam(); }

protected:
    void writeMore(const types::Sonar& sample, const types::Pose& sonar) override;
    bool configureHook() override;
    void cleanupHook() override;

private:
    /** Returns whether a surface in the beam is nearer than `range_min`. */
    bool isTooNear();

    Detector detector_;
    std::unique_ptr<SonarRenderer> near_;  ///< Of the range up to `range_min`; made when it is needed.
    types::Sonar near_ping_;
};

}  // namespace insonify::sonar
