#include "components/sonar/tasks/ProfilerTask.hpp"

#include <cmath>

namespace insonify::sonar {

void ProfilerTask::writeMore(const types::Sonar& sample, const types::Pose& sonar) {
    if (!soundings.connected()) return;
    const auto cloud = clouds_.take();
    cloud->clear();
    cloud->reserve(sample.beam_count);
    cloud->time = sample.time;
    detector_.take(sample, config->detection, detectionRules());
    for (uint32_t beam = 0; beam < sample.beam_count; ++beam)
        if (const auto found = detector_.strongest(beam)) {
            const double bearing = sample.bearings[beam].rad;
            const glm::dvec3 direction(std::cos(bearing), std::sin(bearing), 0);
            cloud->add(sonar.position + sonar.orientation * direction * found->range,
                       static_cast<double>(found->intensity));
        }
    clouds_.stock(*cloud, [&](types::PointCloud& other) { other.reserve(sample.beam_count); });
    soundings.write(cloud);
}

}  // namespace insonify::sonar
