#pragma once
#include "components/framework/Properties.hpp"
#include "components/sonar/bins/Detection.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "types/samples/PointCloud.hpp"
#include "types/samples/SonarDetections.hpp"

namespace insonify::sonar {

/** A fan of thin beams, and the detection of each beam's sounding. */
struct ProfilerConfig {
    SonarConfig sonar;
    DetectionConfig detection;

    ProfilerConfig() { sonar.beam_height_deg = 1; }

    static void describe(auto& self, auto& visit) {
        SonarConfig::describe(self.sonar, visit);
        visit({"detection", "", "how a beam's sounding is found"}, self.detection);
    }
    void check(types::Diagnostics& diagnostics) const { sonar.check(diagnostics); }
};

/** A profiling multibeam sonar: a fan of thin beams, where each beam's strongest return is one sounding.
 *
 *  The fan is in the x-y plane of the sonar frame, about x: a mount with `pitch_deg: 90` looks straight down, with the
 *  fan across the track. In addition to the ping it writes `soundings`: points in the world, at most one for each beam,
 *  with the intensity of the strongest bin of the return; and `detections`: the same returns by beam and travel time.
 *  They are found in the noiseless ping, only while one of the two ports is connected. */
class ProfilerTask final : public PingTask {
public:
    using PingTask::PingTask;

    framework::Properties<ProfilerConfig> config{this};
    framework::OutputPort<types::PointCloudPtr> soundings{
        this, "soundings", "a point in the world for each beam that has a return, at the time of the ping"};
    framework::OutputPort<types::SonarDetectionsPtr> detections{
        this, "detections", "the same by beam: angles, two-way travel times and intensities, in the sonar's frame"};

    SonarConfig sonarConfig() const override { return config->sonar.fan(); }

protected:
    void writeMore(const types::Sonar& sample, const types::Pose& sonar) override;

private:
    Detector detector_;
    framework::SamplePool<types::PointCloud> clouds_;
    framework::SamplePool<types::SonarDetections> all_detections_;
};

}  // namespace insonify::sonar
