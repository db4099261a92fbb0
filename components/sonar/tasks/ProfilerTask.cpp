#include "components/sonar/tasks/ProfilerTask.hpp"

#include <cmath>

namespace insonify::sonar {

void ProfilerTask::writeMore(const types::Sonar& sample, const types::Pose& sonar) {
    if (!soundings.connected() && !detections.connected()) return;
    const auto cloud = clouds_.take();
    cloud->clear();
    cloud->reserve(sample.beam_count);
    cloud->time = sample.time;
    const auto by_beam = all_detections_.take();
    by_beam->copyPing(sample);
    by_beam->reserve(sample.beam_count);
    detector_.take(sample, config->detection, detectionRules());
    for (uint32_t beam = 0; beam < sample.beam_count; ++beam) {
        const auto found = detector_.strongest(beam);
        by_beam->add(sample.bearings[beam], {0}, found ? found->range : types::SonarDetections::no_return,
                     found ? found->intensity : 0);
        if (!found) continue;
        const double bearing = sample.bearings[beam].rad;
        const glm::dvec3 direction(std::cos(bearing), std::sin(bearing), 0);
        cloud->add(sonar.position + sonar.orientation * direction * found->range,
                   static_cast<double>(found->intensity));
    }
    clouds_.stock(*cloud, [&](types::PointCloud& other) { other.reserve(sample.beam_count); });
    all_detections_.stock(*by_beam, [&](types::SonarDetections& other) { other.reserve(sample.beam_count); });
    soundings.write(cloud);
    detections.write(by_beam);
}

}  // namespace insonify::sonar
