#include "components/sonar/AltimeterTask.hpp"

namespace insonify::sonar {

SonarConfig AltimeterConfig::beam() const {
    SonarConfig one = sonar;
    one.bearings_deg = {0};
    return one;
}

void AltimeterTask::writeMore(const types::Sonar& sample, const types::Pose& /*sonar*/) {
    if (!range.connected()) return;
    types::Range reported;
    reported.time = sample.time;
    if (const auto found = Detector(config->detection, sample).first(0)) reported.range = found->range;
    reported.range_min = config->sonar.range_min;
    reported.range_max = sample.binWidth() * sample.bin_count;
    reported.field_of_view = sample.beam_width;
    range.write(reported);
}

}  // namespace insonify::sonar
