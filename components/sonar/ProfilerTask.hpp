#pragma once
#include "components/framework/Properties.hpp"
#include "components/sonar/PingTask.hpp"
#include "components/sonar/echo/Detection.hpp"
#include "types/PointCloud.hpp"

namespace insonify::sonar {

/** A fan of thin beams, and how the sounding of each is found. */
struct ProfilerConfig {
    SonarConfig sonar;
    DetectionConfig detection;

    ProfilerConfig() { sonar.beam_height_deg = 1; }

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        SonarConfig::describe(self.sonar, visit);
        visit(types::Field{"detection", "", "how a beam's sounding is found"}, self.detection);
    }
    void check(types::Diagnostics& diagnostics) const { sonar.check(diagnostics); }
};

/** A profiling multibeam sonar: a fan of thin beams, of each of which the strongest return is one sounding.
 *
 *  The fan lies in the x-y plane of the sonar frame, about x: a mount with `pitch_deg: 90` looks straight down, with
 *  the fan across the track. Out, beside the ping: `soundings`, points in the world, at most one for each beam, with
 *  the intensity of the strongest bin of the return; found in the noiseless ping, only where somebody is connected. */
class ProfilerTask final : public PingTask {
public:
    using PingTask::PingTask;

    framework::Properties<ProfilerConfig> config{this};
    framework::OutputPort<types::PointCloudPtr> soundings{
        this, "soundings", "a point in the world for each beam that has a return, at the time of the ping"};

    SonarConfig sonarConfig() const override { return config->sonar.fan(); }

protected:
    void tellMore(const types::Sonar& sample, const types::Pose& sonar) override;

private:
    framework::SamplePool<types::PointCloud> clouds_;
};

}  // namespace insonify::sonar
